#include <algorithm>

#include "draw/colour.h"
#include "draw/terminal.h"
#include "stats/text_table.h"

namespace synpo {
namespace {

constexpr size_t kMazeWidth = 2 * kGridSide;

// A row of a maze, each stretch of walls or of floor under one colour.
std::string maze_row(const Maze& maze, int row, TerminalColour colour) {
  const bool* wall = &maze.wall[row * kGridSide];
  std::string text;
  for (int from = 0, to; from < kGridSide; from = to) {
    for (to = from + 1; to < kGridSide && wall[to] == wall[from];) ++to;
    const size_t length = 2 * size_t(to - from);
    if (colour == TerminalColour::kNone)
      text += std::string(length, wall[from] ? '#' : ' ');
    else
      text += ground_code(wall[from] ? kPaperWall : kPaperFloor, colour) + std::string(length, ' ') + kPlainCode;
  }
  return text;
}

}  // namespace

std::string terminal_maps(const std::vector<Maze>& mazes, const MapStyle& style, TerminalColour colour, int width) {
  const std::string between = "  ";
  const size_t fitting = std::max<size_t>(1, (size_t(width > 0 ? width : 80) + between.size()) / (kMazeWidth + between.size()));
  const size_t columns = style.columns > 0 ? std::min(fitting, size_t(style.columns)) : fitting;
  std::string text = style.title.empty() ? "" : style.title + "\n\n";
  for (size_t first = 0; first < mazes.size(); first += columns) {
    const size_t end = std::min(mazes.size(), first + columns);
    if (first > 0) text += '\n';
    for (size_t i = first; i < end; ++i) {
      text += mazes[i].name;
      if (i + 1 < end) text += std::string(kMazeWidth + between.size() - std::min(kMazeWidth, text_width(mazes[i].name)), ' ');
    }
    text += '\n';
    for (int row = 0; row < kGridSide; ++row) {
      for (size_t i = first; i < end; ++i) text += (i > first ? between : "") + maze_row(mazes[i], row, colour);
      text += '\n';
    }
  }
  return text;
}

}  // namespace synpo
