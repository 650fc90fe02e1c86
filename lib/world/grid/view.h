// The agent's view: an RGB picture of 16 x 16 pixels.
//
// Cells outside the window (|row difference| and |column difference| at most `radius`) are black, but treasures not yet
// picked are drawn wherever they are. Inside: wall or floor. The agent is drawn over whatever lies in its cell. Radius
// 0 is the blind agent: it sees itself and the treasures, never a wall.
#pragma once
#include <array>
#include <cstdint>

#include "base/rgb.h"
#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"
#include "world/observation.h"
#include "world/world.h"

namespace synpo {

// One colour a kind of cell. Everything but black lies on a corner of its own of the colours' hull as far as it can, so
// that a single linear filter finds any one of them.
enum GridColour : uint8_t {
  kUnseen,
  kFloor,
  kWall,
  kAgent,
  kFirstTreasure
};  // treasures follow in the order of kTreasureLetters
constexpr int kGridColours = kFirstTreasure + kTreasures;
extern const std::array<Rgb, kGridColours> kPalette;

// The colour of every cell, row by row.
void draw_view(const Maze& maze, const GridFrame& frame, int radius, uint8_t colours[kGridCells]);

// Pictures of kGridSide in the colours of kPalette.
const ObservationSpec& grid_observation_spec();

// The network's input: colours [16, 16, history], oldest first. Pictures from before the first step are black.
void draw_history(const Maze& maze, const StateHistory& history, int radius, uint8_t* pictures);

}  // namespace synpo
