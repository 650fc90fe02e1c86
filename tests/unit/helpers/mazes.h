// Hand-made mazes for tests.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "world/grid/maze.h"

namespace synpo {

constexpr uint8_t cell(int row, int column) { return uint8_t(row * kGridSide + column); }

// Floor everywhere inside the outer wall, but for the cells of `walls`.
inline std::string room(const std::vector<uint8_t>& walls = {}) {
  std::string text;
  for (int row = 0; row < kGridSide; ++row) {
    for (int column = 0; column < kGridSide; ++column) {
      const bool border = row % (kGridSide - 1) == 0 || column % (kGridSide - 1) == 0;
      text += border || std::count(walls.begin(), walls.end(), cell(row, column)) ? '#' : ' ';
    }
    text += '\n';
  }
  return text;
}

inline Maze open_maze() { return parse_maze("open", room(), "open"); }

}  // namespace synpo
