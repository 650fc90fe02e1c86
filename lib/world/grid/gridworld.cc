#include "world/grid/gridworld.h"

#include <algorithm>

namespace synpo {

const char* const kGridActionNames[kGridActions] = {"UP", "DOWN", "LEFT", "RIGHT", "PICK"};

WorldState to_world_state(const GridState& state) {
  WorldState out;
  out.bytes[0] = state.now.agent;
  std::copy(state.now.treasures.begin(), state.now.treasures.end(), out.bytes.begin() + 1);
  out.bytes[1 + kTreasures] = state.picked;
  out.steps = state.steps;
  return out;
}

GridState to_grid_state(const WorldState& state) {
  GridState out;
  out.now.agent = state.bytes[0];
  std::copy_n(state.bytes.begin() + 1, kTreasures, out.now.treasures.begin());
  out.picked = state.bytes[1 + kTreasures];
  out.steps = state.steps;
  return out;
}

GridState grid_reset(const Maze& maze, Random& random) {
  const auto any_free_cell = [&] { return maze.free_cells[random.below(uint32_t(maze.free_cells.size()))]; };
  GridState state;
  state.now.agent = any_free_cell();
  for (int i = 0; i < kTreasures; ++i) {
    uint8_t cell;
    bool taken;
    do {
      cell = any_free_cell();
      taken = false;
      for (int j = 0; j < i; ++j) taken |= state.now.treasures[j] == cell;
    } while (taken);
    state.now.treasures[i] = cell;
  }
  return state;
}

int treasure_under_agent(const GridFrame& frame) {
  for (int i = 0; i < kTreasures; ++i)
    if (frame.treasures[i] == frame.agent) return i;
  return -1;
}

WorldStep grid_step(const Maze& maze, const Task& task, GridState& state, int action) {
  static constexpr int offsets[4] = {-kGridSide, kGridSide, -1, 1};
  WorldStep step = {-1, false, false, false, false};
  ++state.steps;
  if (action == kPick) {
    const int found = treasure_under_agent(state.now);
    if (found >= 0 && found == next_target(task, state)) {
      state.now.treasures[found] = kPicked;
      step.reward_cents += 100;
      if (++state.picked == 2) {
        step.reward_cents += 1000;
        step.terminated = step.success = true;
      }
    } else if (found >= 0) {
      step.reward_cents -= 1000;
      step.terminated = step.wrong = true;
    }
  } else {
    // The outer wall keeps the sum inside the grid.
    const uint8_t target = uint8_t(state.now.agent + offsets[action]);
    if (maze.wall[target])
      step.reward_cents -= 1;
    else
      state.now.agent = target;
  }
  step.truncated = !step.terminated && state.steps >= kStepLimit;
  return step;
}

}  // namespace synpo
