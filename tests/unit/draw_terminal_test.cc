#include <gtest/gtest.h>

#include <cstdlib>

#include "draw/terminal.h"

namespace synpo {
namespace {

HeatTable table() {
  Matrix m;
  const auto add = [&](const char* env, const char* task, bool seen, int64_t k, int64_t n) {
    MatrixRow row;
    row.env = env;
    row.task = task;
    row.seen = seen;
    row.successes = k;
    row.episodes = n;
    m.rows.push_back(row);
  };
  add("map1", "push", true, 100, 100);
  add("map2", "push", false, 999, 1000);
  add("map10", "lift", true, 1, 1000);
  return pool_matrix(m);
}

TEST(Terminal, WithoutColour) {
  EXPECT_EQ(terminal_matrix(table(), find_scheme("safe"), TerminalColour::kNone, 10),
            "100 to 1000 episodes a pair\n"
            " map   1   2  10\n"
            "push 100  99*\n"
            "lift           1\n"
            "\n"
            "seen: 9.2 % of 1100 episodes, 2 pairs\n"
            "unseen (*): 99.9 % of 1000 episodes, 1 pair\n");
}

TEST(Terminal, BlocksShrinkToTheWidth) {
  const auto second_line = [](int width) {
    const std::string text = terminal_matrix(table(), find_scheme("safe"), TerminalColour::kTrue, width);
    const size_t at = text.find("\npush ") + 1;
    std::string line = text.substr(at, text.find('\n', at) - at), plain;
    for (size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\033') i = line.find('m', i);
      else plain += line[i];
    }
    return plain;
  };
  EXPECT_EQ(second_line(0), "push  100  99    ");
  EXPECT_EQ(second_line(17), "push  100  99    ");
  EXPECT_EQ(second_line(16), "push 100 99   ");
  EXPECT_EQ(second_line(13), "push       ");
  EXPECT_EQ(second_line(4), "push    ");
}

TEST(Terminal, ColourCodes) {
  EXPECT_EQ(ground_code({255, 255, 255}, TerminalColour::kTrue), "\033[38;5;16;48;2;255;255;255m");
  EXPECT_EQ(ground_code({0, 0, 100}, TerminalColour::k256), "\033[38;5;231;48;5;17m");
  EXPECT_EQ(ground_code({255, 0, 0}, TerminalColour::k256), "\033[38;5;16;48;5;196m");
  EXPECT_EQ(ground_code({0, 0, 0}, TerminalColour::kNone), "");
}

TEST(Terminal, TheEnvironmentDecides) {
  const auto colour = [](const char* term, const char* depth, const char* none) {
    setenv("TERM", term, 1);
    setenv("COLORTERM", depth, 1);
    setenv("NO_COLOR", none, 1);
    return environment_colour();
  };
  EXPECT_EQ(colour("xterm-256color", "", ""), TerminalColour::k256);
  EXPECT_EQ(colour("xterm", "truecolor", ""), TerminalColour::kTrue);
  EXPECT_EQ(colour("xterm", "truecolor", "1"), TerminalColour::kNone);
  EXPECT_EQ(colour("dumb", "truecolor", ""), TerminalColour::kNone);
  EXPECT_EQ(colour("", "", ""), TerminalColour::kNone);
  for (const char* name : {"TERM", "COLORTERM", "NO_COLOR"}) unsetenv(name);
  EXPECT_EQ(terminal_colour(-1), TerminalColour::kNone);
  EXPECT_EQ(terminal_width(-1), 0);
}

}  // namespace
}  // namespace synpo
