// The mazes of GridWorld: 16 x 16 cells, '#' wall, ' ' or '@' floor, as text.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace synpo {

constexpr int kGridSide = 16;
constexpr int kGridCells = kGridSide * kGridSide;

// A cell's index is row * 16 + column; row 0 is the top.
struct Maze {
  std::string name;  // the file's stem: map1
  std::array<bool, kGridCells> wall;
  std::vector<uint8_t> free_cells;  // ascending
  uint64_t hash;                    // of canonical_text()

  // 16 lines of 16 characters, '#' and '@', each ended by a newline.
  std::string canonical_text() const;
};

// Parses map text. Blanks at the end of a line may be missing (floor; wall in the outermost column), and there may be
// more of them; so may blank last lines. `where` names the source in messages. Throws kData for another size, a foreign
// character, an outer wall with a hole, fewer than 6 free cells, or floor that is not connected.
Maze parse_maze(const std::string& name, const std::string& text, const std::string& where);

// map1 to map20, built into the library.
const std::vector<Maze>& builtin_mazes();

// Every *.txt of a folder in natural order (map2 before map10), but for names that begin with a dot. Throws kNoInput
// when there is none, kData, before any file is read, for one whose stem cannot be a name (base/text.h).
std::vector<Maze> load_mazes(const std::string& folder);

// The mazes of a world by its name on the command line: "gridworld" or "gridworld:DIR". Throws kUsage for another.
std::vector<Maze> open_mazes(const std::string& world);

}  // namespace synpo
