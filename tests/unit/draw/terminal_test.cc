#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "base/cli/screen.h"
#include "draw/terminal/block_plans.h"
#include "draw/terminal/terminal.h"
#include "draw/worlds/faces.h"
#include "helpers/heat_tables.h"
#include "world/grid/maze.h"

namespace synpo {
namespace {

HeatTable table() {
  Matrix m;
  m.rows = {matrix_row("map1", "push", true, 100, 100), matrix_row("map2", "push", false, 999, 1000),
            matrix_row("map10", "lift", true, 1, 1000)};
  for (MatrixRow& row : m.rows) row.method = row.run = "";
  return pool_matrix(m);
}

// Names of mazes that stand in the first line.
size_t mazes_in_a_row(int64_t columns, int width) {
  MapStyle style;
  style.columns = columns;
  const std::unique_ptr<const WorldFace> face = open_face("gridworld");
  std::vector<int> all(size_t(face->world().envs()));
  std::iota(all.begin(), all.end(), 0);
  const std::string text = face->plans_text(all, style, TerminalColour::kNone, width),
                    line = text.substr(0, text.find('\n'));
  size_t names = 0;
  for (size_t at = line.find("map"); at != std::string::npos; at = line.find("map", at + 1)) ++names;
  return names;
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

TEST(Terminal, GroupsWithoutPairsAreNotNamed) {
  HeatTable with_empty = table();
  with_empty.groups.push_back({"rest"});
  for (const TerminalColour colour : {TerminalColour::kNone, TerminalColour::kTrue})
    EXPECT_EQ(terminal_matrix(with_empty, find_scheme("safe"), colour, 10),
              terminal_matrix(table(), find_scheme("safe"), colour, 10));
}

TEST(Terminal, BlocksShrinkToTheWidth) {
  const auto second_line = [](int width) {
    const std::string text = terminal_matrix(table(), find_scheme("safe"), TerminalColour::kTrue, width);
    const size_t at = text.find("\npush ") + 1;
    std::string line = text.substr(at, text.find('\n', at) - at), plain;
    for (size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\033')
        i = line.find('m', i);
      else
        plain += line[i];
    }
    return plain;
  };
  EXPECT_EQ(second_line(0), "push  100  99    ");
  EXPECT_EQ(second_line(17), "push  100  99    ");
  EXPECT_EQ(second_line(16), "push 100 99   ");
  EXPECT_EQ(second_line(13), "push       ");
  EXPECT_EQ(second_line(4), "push    ");
}

// Environments named `env` and a number, tasks named `task` and a number.
HeatTable named(const std::string& env, const std::string& task) {
  Matrix m;
  for (const char* e : {"1", "2"})
    for (const char* t : {"7", "8"}) m.rows.push_back(matrix_row(env + e, task + t, true, 1, 1));
  return pool_matrix(m);
}

TEST(Terminal, LongNamesAreShortenedSoThatTheyStayDifferent) {
  const auto text = [&](const HeatTable& table, int width) {
    return terminal_matrix(table, find_scheme("safe"), TerminalColour::kNone, width);
  };
  const HeatTable tasks = named("map", "put_the_first_thing_into_receptacle_");
  EXPECT_NE(text(tasks, 0).find("\nput_the_first_thing_into_receptacle_7 100 100\n"), std::string::npos);
  // 30 columns less two cells and a blank are 21.
  EXPECT_NE(text(tasks, 30).find("\nput_the_fi..eptacle_7 100 100\nput_the_fi..eptacle_8 100 100\n"), std::string::npos)
      << text(tasks, 30);
  EXPECT_NE(text(tasks, 5).find("\nput_the..tacle_8 100 100\n"), std::string::npos) << text(tasks, 5);
  // What the environments' names share stands above those of the tasks, on no more than sixteen columns.
  EXPECT_NE(
      text(named("a_rather_long_maze_", "push"), 0).find("\na_rathe..g_maze_   1   2\npush7            100 100\n"),
      std::string::npos)
      << text(named("a_rather_long_maze_", "push"), 0);
  // Names that are read downwards have twelve lines, and differ in the last.
  HeatTable envs = named("map", "push");
  envs.envs = {"environment_of_kind_a", "environment_of_kind_b"};
  const std::string downwards = text(envs, 0);
  EXPECT_EQ(std::count(downwards.begin(), downwards.begin() + ptrdiff_t(downwards.find("push7")), '\n'), 1 + 12);
  EXPECT_NE(downwards.find("\n        a   b\npush7"), std::string::npos) << downwards;
}

TEST(Terminal, CharactersOfTwoColumnsAreAligned) {
  // Two characters on four columns, and a letter with an accent on one.
  const std::string text =
      terminal_matrix(named("\u73af\u5883", "e\u0301te"), find_scheme("safe"), TerminalColour::kNone, 0);
  EXPECT_NE(text.find("\n\u73af\u5883   1   2\ne\u0301te7 100 100\n"), std::string::npos) << text;
}

TEST(Terminal, PlansStandBeneathTheirNames) {
  std::vector<BlockPlan> plans;
  for (const char* name : {"the_first_kitchen", "the_first_kitchens"})
    plans.push_back({name, 1, 6, [](int, int) { return Block{{}, ' ', '#'}; }});
  EXPECT_EQ(terminal_plans(plans, {}, TerminalColour::kNone, 80),
            "the_f..tchen  the_f..chens\n"
            "############  ############\n");
}

TEST(Terminal, Mazes) {
  const Maze& maze = builtin_mazes()[0];
  const std::unique_ptr<const WorldFace> face = open_face("gridworld");
  MapStyle style;
  style.title = "One";
  const std::string plain = face->plans_text({0}, style, TerminalColour::kNone, 80);
  ASSERT_TRUE(plain.starts_with("One\n\nmap1\n" + std::string(32, '#') + '\n'));
  const size_t first = plain.find('#');
  for (int cell = 0; cell < kGridCells; ++cell)
    EXPECT_EQ(plain[first + cell / kGridSide * (2 * kGridSide + 1) + cell % kGridSide * 2], maze.wall[cell] ? '#' : ' ')
        << cell;
  const std::string coloured = face->plans_text({0}, {}, TerminalColour::kTrue, 80);
  EXPECT_TRUE(coloured.starts_with("map1\n\033[38;5;231;48;2;62;70;82m" + std::string(32, ' ') + "\033[0m\n"));
  EXPECT_EQ(coloured.find('#'), std::string::npos);
}

TEST(Terminal, MazesInARow) {
  EXPECT_EQ(mazes_in_a_row(0, 0), 2u);
  EXPECT_EQ(mazes_in_a_row(0, 66), 2u);
  EXPECT_EQ(mazes_in_a_row(0, 65), 1u);
  EXPECT_EQ(mazes_in_a_row(0, 10), 1u);
  EXPECT_EQ(mazes_in_a_row(0, 10000), 20u);
  EXPECT_EQ(mazes_in_a_row(3, 10000), 3u);
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
  EXPECT_EQ(forced_colour(), TerminalColour::k256);
  setenv("NO_COLOR", "1", 1);
  setenv("COLORTERM", "24bit", 1);
  EXPECT_EQ(forced_colour(), TerminalColour::kTrue);
  for (const char* name : {"TERM", "COLORTERM", "NO_COLOR"}) unsetenv(name);
  EXPECT_EQ(terminal_colour(-1), TerminalColour::kNone);
  EXPECT_EQ(screen_size(-1).columns, 0);
}

}  // namespace
}  // namespace synpo
