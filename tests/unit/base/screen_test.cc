#include "base/cli/screen.h"

#include <gtest/gtest.h>

#include <string>

namespace synpo {
namespace {

TEST(Screen, TextIsBrokenAtBlanksAndIndented) {
  EXPECT_EQ(wrapped("one two three", 0, 2, 80), "one two three");
  EXPECT_EQ(wrapped("one two three", 0, 2, 7), "one two\n  three");
  EXPECT_EQ(wrapped("one two three", 4, 2, 11), "one two\n  three");
  EXPECT_EQ(wrapped("one two three", 5, 2, 11), "one\n  two three");
  EXPECT_EQ(wrapped("a-word-that-is-too-long for it", 0, 1, 5), "a-word-that-is-too-long\n for\n it");
  EXPECT_EQ(wrapped("first\nsecond line", 0, 3, 9), "first\n   second\n   line");
  EXPECT_EQ(wrapped("", 0, 3, 9), "");
}

TEST(Screen, WhatBelongsTogetherIsNotBroken) {
  // A line that began with a dash would look like an option.
  EXPECT_EQ(wrapped("instead of -n: all", 0, 2, 12), "instead\n  of -n: all");
  EXPECT_EQ(wrapped("tool [-n N | -t LIMIT] FILE", 0, 2, 19), "tool\n  [-n N | -t LIMIT]\n  FILE");
  EXPECT_EQ(wrapped("tool < IN > OUT", 0, 2, 10), "tool < IN\n  > OUT");
}

TEST(Screen, AShellReadsAQuotedWordBack) {
  EXPECT_EQ(shell_quoted("run.ckpt"), "run.ckpt");
  EXPECT_EQ(shell_quoted("gridworld:a/b_c-1"), "gridworld:a/b_c-1");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("a b"), "'a b'");
  EXPECT_EQ(shell_quoted("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_quoted("~/x"), "'~/x'");
}

}  // namespace
}  // namespace synpo
