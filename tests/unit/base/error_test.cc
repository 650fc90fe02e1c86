#include "base/error.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(Quoted, ShowsForeignInputSafely) {
  EXPECT_EQ(quoted("map1"), "'map1'");
  EXPECT_EQ(quoted(""), "''");
  EXPECT_EQ(quoted("a\tb\n\x1b[31m\x7f"), "'a\\x09b\\x0a\\x1b[31m\\x7f'");
  EXPECT_EQ(quoted("\xc3\xa9\xff\xc3"), "'\xc3\xa9\\xff\\xc3'");
  EXPECT_EQ(quoted("\xc2\x9b"), "'\\xc2\\x9b'");         // a C1 control character
  EXPECT_EQ(quoted("a\u202eb"), "'a\\xe2\\x80\\xaeb'");  // turns the direction
  EXPECT_EQ(quoted(std::string("\0x", 2)), "'\\x00x'");
  // What would show as nothing, or as a blank of another kind.
  EXPECT_EQ(quoted("a\u200b"), "'a\\xe2\\x80\\x8b'");
  EXPECT_EQ(quoted("\ufeffa"), "'\\xef\\xbb\\xbfa'");
  EXPECT_EQ(quoted("a\u00a0b c"), "'a\\xc2\\xa0b c'");
  EXPECT_EQ(quoted("a\u2028b"), "'a\\xe2\\x80\\xa8b'");
  EXPECT_EQ(quoted("a\U000e0041"), "'a\\xf3\\xa0\\x81\\x81'");
  EXPECT_EQ(quoted("e\u0301\u4e2d\U0001f600"), "'e\u0301\u4e2d\U0001f600'");
  const std::string cut = quoted(std::string(1000, 'a'));
  EXPECT_LT(cut.size(), 70u);
  EXPECT_TRUE(cut.ends_with("a...'"));
}

}  // namespace
}  // namespace synpo
