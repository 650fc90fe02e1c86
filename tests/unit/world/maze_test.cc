#include "world/grid/maze.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/text.h"
#include "helpers/mazes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "world/grid/grid_set.h"

namespace synpo {
namespace {

TEST(BuiltinMazes, AreTwentyDifferentOnes) {
  const std::vector<Maze>& mazes = builtin_mazes();
  ASSERT_EQ(mazes.size(), 20u);
  std::set<uint64_t> hashes;
  std::set<std::string> texts;
  int plain = 0;
  for (size_t i = 0; i < mazes.size(); ++i) {
    EXPECT_EQ(mazes[i].name, "map" + std::to_string(i + 1));
    hashes.insert(mazes[i].hash);
    texts.insert(mazes[i].canonical_text());
    plain += mazes[i].free_cells.size() == 152;
    EXPECT_EQ(mazes[i].free_cells.size(), size_t(std::count(mazes[i].wall.begin(), mazes[i].wall.end(), false)));
  }
  EXPECT_EQ(hashes.size(), 20u);
  EXPECT_EQ(texts.size(), 20u);
  EXPECT_EQ(plain, 19);
}

TEST(Maze, ReadsText) {
  const Maze maze = parse_maze("m", room({cell(3, 4)}), "m.txt");
  EXPECT_TRUE(maze.wall[cell(3, 4)]);
  EXPECT_TRUE(maze.wall[cell(0, 7)]);
  EXPECT_FALSE(maze.wall[cell(4, 3)]);
  EXPECT_EQ(maze.free_cells.size(), 14u * 14 - 1);
  EXPECT_TRUE(std::is_sorted(maze.free_cells.begin(), maze.free_cells.end()));
  const std::string canonical = maze.canonical_text();
  EXPECT_EQ(canonical.size(), 16u * 17);
  EXPECT_EQ(canonical.substr(3 * 17, 17), "#@@@#@@@@@@@@@@#\n");
  // '@' is floor too, and ends of lines and of the file may differ.
  EXPECT_EQ(parse_maze("m", canonical, "m.txt").hash, maze.hash);
  EXPECT_EQ(parse_maze("m", room({cell(3, 4)}) + "\n   \n", "m.txt").hash, maze.hash);
  std::string other = room({cell(3, 4)});
  other.pop_back();
  EXPECT_EQ(parse_maze("m", other, "m.txt").hash, maze.hash);
  for (size_t at = 0; (at = other.find('\n', at)) != std::string::npos; at += 2) other.insert(at, "\r");
  EXPECT_EQ(parse_maze("m", other, "m.txt").hash, maze.hash);
  EXPECT_NE(parse_maze("m", room(), "m.txt").hash, maze.hash);
}

TEST(Maze, BlanksAtTheEndOfALineMayBeMissingOrTooMany) {
  const Maze maze = parse_maze("m", room({cell(5, 9)}), "m.txt");
  std::string text = room({cell(5, 9)});
  text.insert(17 * 7 + 16, "    ");
  text.erase(17 * 5 + 10, 6);  // what is missing is floor, and the wall at its end
  EXPECT_EQ(parse_maze("m", text, "m.txt").canonical_text(), maze.canonical_text());
}

std::string maze_refused(const std::string& text) {
  return thrown([&] { parse_maze("m", text, "m.txt"); });
}

TEST(Maze, RefusesOtherTexts) {
  const std::string good = room();
  EXPECT_EQ(maze_refused(""), "65 m.txt: found nothing, expected a maze of 16 lines of 16 characters");
  EXPECT_EQ(maze_refused("   \n   \n"), "65 m.txt: found blanks alone, expected a maze of 16 lines of 16 characters");
  EXPECT_EQ(maze_refused(good.substr(17)), "65 m.txt: found 15 lines, expected a maze of 16 lines of 16 characters");
  EXPECT_EQ(maze_refused(good + "################\n"),
            "65 m.txt: found 17 lines, expected a maze of 16 lines of 16 characters");
  std::string wide = good;
  wide.insert(17 + 16, "#");
  EXPECT_EQ(maze_refused(wide), "65 m.txt: line 2: found 17 characters, expected 16");
  std::string foreign = good;
  foreign[2 * 17 + 4] = 'x';
  EXPECT_EQ(maze_refused(foreign), "65 m.txt: line 3, column 5: found 'x', expected '#' (wall), ' ' or '@' (floor)");
  foreign[2 * 17 + 4] = '\0';
  EXPECT_EQ(maze_refused(foreign), "65 m.txt: line 3, column 5: found U+0000, expected '#' (wall), ' ' or '@' (floor)");
  std::string empty = good;
  empty.erase(17 * 5, 16);
  EXPECT_EQ(maze_refused(empty), "65 m.txt: line 6: found an empty line, expected 16 characters");
  for (const size_t at : {5u, 17u * 15 + 5, 17u * 5, 17u * 5 + 15}) {
    std::string hole = good;
    hole[at] = ' ';
    EXPECT_EQ(maze_refused(hole), concat("65 m.txt: line ", at / 17 + 1, ", column ", at % 17 + 1,
                                         ": found floor, expected the outer wall"));
  }
  EXPECT_EQ(maze_refused(room({cell(1, 2), cell(2, 1)})),
            "65 m.txt: line 2, column 4: this floor cannot be reached from that in line 2, column 2");
  std::string full;
  for (int row = 0; row < 16; ++row) full += row == 3 ? "#@@@@@##########\n" : "################\n";
  EXPECT_EQ(maze_refused(full), "65 m.txt: found 5 floor cells, expected at least 6");
}

TEST(Maze, NamesWhatCannotBeSeen) {
  const std::string good = room();
  const auto with = [&](const std::string& text, size_t row, size_t column) {
    std::string maze = good;
    maze.replace(row * 17 + column, 1, text);
    return maze_refused(maze);
  };
  const auto found = [](int line, int column, const std::string& what) {
    return concat("65 m.txt: line ", line, ", column ", column, ": found ", what,
                  ", expected '#' (wall), ' ' or '@' (floor)");
  };
  EXPECT_EQ(maze_refused("\xef\xbb\xbf" + good), found(1, 1, "a byte order mark"));
  EXPECT_EQ(with("\xc2\xa0", 3, 4), found(4, 5, "a no-break space"));
  EXPECT_EQ(with("\t", 3, 4), found(4, 5, "a tab"));
  EXPECT_EQ(with("#\t", 3, 15), found(4, 17, "a tab"));
  EXPECT_EQ(with("\xe2\x80\x8b", 3, 4), found(4, 5, "U+200B"));
  EXPECT_EQ(with("\xc3\xa9", 3, 4), found(4, 5, "'\xc3\xa9'"));
  // Columns are characters: the one after a block of three bytes is the next.
  EXPECT_EQ(with("\xe2\x96\x88", 0, 0), found(1, 1, "'\xe2\x96\x88'"));
  EXPECT_EQ(with("\xff", 3, 4), found(4, 5, "the byte \\xff"));
  EXPECT_EQ(with("#\u0301", 3, 4), found(4, 6, "U+0301"));  // an accent on the character before
  EXPECT_EQ(with("\ufe0f", 3, 4), found(4, 5, "U+FE0F"));
  EXPECT_EQ(with("\r", 3, 4), found(4, 5, "a carriage return"));
  EXPECT_EQ(maze_refused("\xff\xfe#"), "65 m.txt: found UTF-16, expected plain ASCII text");
  EXPECT_EQ(maze_refused(std::string("\xff\xfe\0\0#\0\0\0", 8)), "65 m.txt: found UTF-32, expected plain ASCII text");
  std::string gap = good;
  EXPECT_EQ(maze_refused(gap.insert(5 * 17, "\n")), "65 m.txt: line 6: found an empty line, expected 16 characters");
  std::string cr = good;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  EXPECT_EQ(maze_refused(cr), "65 m.txt: lines end in CR alone, expected LF or CR LF");
}

TEST(Maze, FoldersAreReadInNaturalOrder) {
  const TemporaryFolder folder;
  for (const char* name : {"map10.txt", "map2.txt", "map1.txt", "hall.txt", "notes.md", "map3.txt~", ".map4.txt"})
    folder.file(name, room());
  std::string names;
  for (const Maze& maze : load_mazes(folder.path())) names += maze.name + " ";
  EXPECT_EQ(names, "hall map1 map2 map10 ");
  EXPECT_EQ(GridSet::open("gridworld:" + folder.path()).envs(), 4);
  folder.file("map4.txt", "#\n");
  EXPECT_EQ(thrown([&] { load_mazes(folder.path()); }),
            "65 " + folder.file("map4.txt") + ": found 1 lines, expected a maze of 16 lines of 16 characters");
}

TEST(Maze, AFileThatCannotBeANameIsRefusedBeforeAnyIsRead) {
  const TemporaryFolder folder;
  folder.file("a.txt", "#\n");
  folder.file("map\xe9.txt", room());
  EXPECT_EQ(thrown([&] { load_mazes(folder.path()); }),
            "65 'map\\xe9.txt' in the folder '" + folder.path() +
                "': found invalid UTF-8 at byte 4 of the name (\\xe9), expected UTF-8 text");
}

TEST(Maze, AFolderWithoutMapsIsMissingInput) {
  const TemporaryFolder folder;
  folder.file("notes.md", room());
  EXPECT_EQ(thrown([&] { load_mazes(folder.path()); }), "66 no *.txt in the folder '" + folder.path() + "'");
  EXPECT_EQ(thrown([&] { load_mazes(folder.file("none")); }),
            "66 cannot read the folder '" + folder.file("none") + "': No such file or directory");
}

TEST(Maze, NaturalOrder) {
  const std::vector<std::string> ordered = {"",      "1",      "2",       "10",    "a",     "map",    "map1", "map2",
                                            "map2a", "map2a3", "map2a12", "map10", "map11", "map100", "mapa"};
  for (size_t i = 0; i < ordered.size(); ++i)
    for (size_t j = 0; j < ordered.size(); ++j)
      EXPECT_EQ(natural_less(ordered[i], ordered[j]), i < j) << ordered[i] << " " << ordered[j];
  EXPECT_NE(natural_less("map01", "map1"), natural_less("map1", "map01"));
}

}  // namespace
}  // namespace synpo
