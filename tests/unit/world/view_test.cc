#include "world/grid/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "helpers/mazes.h"
#include "world/grid/grid_set.h"

namespace synpo {
namespace {

// Treasures in a row at the bottom of an open maze.
GridState start_at(uint8_t agent) {
  GridState state;
  state.now = {agent, {cell(14, 1), cell(14, 2), cell(14, 3), cell(14, 4), cell(14, 5)}};
  return state;
}

// One cell's colour by the rules, from the top layer down.
int colour_of(const Maze& maze, const GridFrame& frame, int radius, int at) {
  if (at == frame.agent) return kAgent;
  for (int i = 0; i < kTreasures; ++i)
    if (frame.treasures[i] != kPicked && frame.treasures[i] == at) return kFirstTreasure + i;
  const int rows = std::abs(at / kGridSide - frame.agent / kGridSide),
            columns = std::abs(at % kGridSide - frame.agent % kGridSide);
  if (rows > radius || columns > radius) return kUnseen;
  return maze.wall[at] ? kWall : kFloor;
}

TEST(View, FollowsTheRules) {
  const std::vector<Maze>& mazes = builtin_mazes();
  for (int i = 0; i < 2000; ++i) {
    const Maze& maze = mazes[i % mazes.size()];
    Random random(5, Purpose::kEpisodeStart, 0, uint64_t(i));
    GridState state = grid_reset(maze, random);
    if (i % 2) state.now.treasures[1 + i % 4] = kPicked;
    if (i % 5 == 0) state.now.agent = state.now.treasures[0];
    for (const int radius : {0, 1, 2, 16}) {
      uint8_t view[kGridCells];
      draw_view(maze, state.now, radius, view);
      for (int at = 0; at < kGridCells; ++at)
        ASSERT_EQ(int(view[at]), colour_of(maze, state.now, radius, at)) << "radius " << radius;
    }
  }
}

// The picture as text: ' ' unseen, '.' floor, '#' wall, '@' agent, letters for treasures.
std::string shown(const uint8_t* view, int rows) {
  std::string text;
  for (int at = 0; at < rows * kGridSide; ++at) {
    text += (std::string(" .#@") + kTreasureLetters)[view[at]];
    if (at % kGridSide == kGridSide - 1) text += '\n';
  }
  return text;
}

TEST(View, OnePictureByHand) {
  GridFrame frame = {cell(1, 1), {cell(1, 2), cell(1, 1), cell(2, 14), kPicked, cell(3, 7)}};
  uint8_t view[kGridCells];
  draw_view(open_maze(), frame, 1, view);
  EXPECT_EQ(shown(view, 4),
            "###             \n"
            "#@R             \n"
            "#..           G \n"
            "       P        \n");
  draw_view(open_maze(), frame, 0, view);
  EXPECT_EQ(shown(view, 4),
            "                \n"
            " @R             \n"
            "              G \n"
            "       P        \n");
}

TEST(View, ColoursDiffer) {
  std::set<int> colours;
  for (const Rgb& rgb : kPalette) colours.insert(rgb.r << 16 | rgb.g << 8 | rgb.b);
  EXPECT_EQ(colours.size(), size_t(kGridColours));
  EXPECT_EQ(kPalette[kUnseen].r + kPalette[kUnseen].g + kPalette[kUnseen].b, 0);
}

TEST(History, NewestIsLastAndMissingOnesAreUnseen) {
  const Maze maze = open_maze();
  StateHistory history;
  std::vector<GridFrame> frames;
  for (int step = 0; step < 7; ++step) {
    const GridState state = start_at(cell(2, 2 + step));
    frames.push_back(state.now);
    history.push(to_world_state(state));
    std::vector<uint8_t> pictures(kGridCells * kHistory, 99);
    draw_history(maze, history, 1, pictures.data());
    for (int f = 0; f < kHistory; ++f) {
      const int frame = step - (kHistory - 1) + f;
      for (int at = 0; at < kGridCells; ++at)
        ASSERT_EQ(int(pictures[at * kHistory + f]), frame < 0 ? int(kUnseen) : colour_of(maze, frames[frame], 1, at))
            << step;
    }
  }
}

}  // namespace
}  // namespace synpo
