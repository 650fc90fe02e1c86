#include "world/grid/view.h"

#include <algorithm>
#include <cstring>

namespace synpo {

const std::array<Rgb, kGridColours> kPalette = {{
    {0, 0, 0},        // unseen
    {50, 50, 50},     // floor
    {110, 80, 50},    // wall
    {255, 255, 255},  // agent
    {255, 0, 0},      // R
    {0, 0, 255},      // B
    {0, 255, 0},      // G
    {255, 170, 0},    // O
    {170, 0, 255},    // P
}};

namespace {

// Colours the cells that are not black; those of one picture lie `stride` bytes apart.
void paint(const Maze& maze, const GridFrame& frame, int radius, uint8_t* colours, int stride) {
  const int row = frame.agent / kGridSide, column = frame.agent % kGridSide;
  for (int r = std::max(0, row - radius); r <= std::min(kGridSide - 1, row + radius); ++r)
    for (int c = std::max(0, column - radius); c <= std::min(kGridSide - 1, column + radius); ++c)
      colours[(r * kGridSide + c) * stride] = maze.wall[r * kGridSide + c] ? kWall : kFloor;
  for (int i = 0; i < kTreasures; ++i)
    if (frame.treasures[i] != kPicked) colours[frame.treasures[i] * stride] = uint8_t(kFirstTreasure + i);
  colours[frame.agent * stride] = kAgent;
}

}  // namespace

void draw_view(const Maze& maze, const GridFrame& frame, int radius, uint8_t colours[kGridCells]) {
  std::memset(colours, kUnseen, kGridCells);
  paint(maze, frame, radius, colours, 1);
}

const ObservationSpec& grid_observation_spec() {
  static const ObservationSpec spec = {Sight::kPictures, kGridSide, {kPalette.begin(), kPalette.end()}};
  return spec;
}

void draw_history(const Maze& maze, const StateHistory& history, int radius, uint8_t* pictures) {
  std::memset(pictures, kUnseen, kGridCells * kHistory);
  for (int f = kHistory - history.count; f < kHistory; ++f)
    paint(maze, to_grid_state(history.states[f]).now, radius, pictures + f, kHistory);
}

}  // namespace synpo
