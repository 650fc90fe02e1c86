// GridWorld's rules.
//
// Five treasures lie on distinct free cells; the agent starts on any free cell. A task is to pick two of them in order.
// Actions UP DOWN LEFT RIGHT PICK cost 0.01 each; walking into a wall costs another 0.01 and stays; PICK on an empty
// cell does nothing more. Picking the right next treasure gives +1 and takes it off the map; the last one gives +10
// more and ends the episode in success. Picking any other treasure gives -10 and ends the episode. After 300 steps an
// episode that has not ended is cut: truncated, not terminated.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/random.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"
#include "world/world.h"

namespace synpo {

constexpr int kGridActions = 5;
constexpr int kGridRules = 1;     // version of the rules above; trajectories and checkpoints carry it
constexpr uint8_t kPicked = 255;  // in place of the cell of a treasure that is no longer there

enum GridAction : uint8_t { kUp, kDown, kLeft, kRight, kPick };
extern const char* const kGridActionNames[kGridActions];

// The part of a state that can be seen: one picture's worth.
struct GridFrame {
  uint8_t agent;
  std::array<uint8_t, kTreasures> treasures;  // cell, or kPicked
  bool operator==(const GridFrame&) const = default;
};

// In checkpoints; more than a state fills.
constexpr size_t kGridStateBytes = 14;

struct GridState {
  GridFrame now;
  uint8_t picked = 0;  // treasures of the task picked so far, 0 to 2
  uint16_t steps = 0;
  bool operator==(const GridState&) const = default;
};

// A world's bytes: the agent's cell, the treasures' cells, how many are picked; the rest is zero.
WorldState to_world_state(const GridState& state);
GridState to_grid_state(const WorldState& state);

// Agent and treasures placed at random, all free cells alike.
GridState grid_reset(const Maze& maze, Random& random);
WorldStep grid_step(const Maze& maze, const Task& task, GridState& state, int action);
// The treasure on the agent's cell, or -1.
int treasure_under_agent(const GridFrame& frame);
// The treasure to pick next.
inline int next_target(const Task& task, const GridState& state) {
  return state.picked == 0 ? task.first : task.second;
}

}  // namespace synpo
