#include "world/grid/planner.h"

#include <cstddef>

#include "world/world.h"

namespace synpo {
namespace {
constexpr uint8_t kUnreachable = 255;
constexpr int kFirstPick = 100, kLastPick = 1100, kStep = -1;  // in hundredths
}  // namespace

Planner::Planner(const Maze& maze)
    : maze_(&maze), distance_(kGridCells * kGridCells, kUnreachable), first_move_(kGridCells * kGridCells, kPick) {
  static constexpr int offsets[4] = {-kGridSide, kGridSide, -1, 1};
  for (const uint8_t goal : maze.free_cells) {
    std::vector<uint8_t> queue = {goal};
    distance_[goal * kGridCells + goal] = 0;
    for (size_t head = 0; head < queue.size(); ++head) {
      const int cell = queue[head];
      for (const int offset : offsets) {
        uint8_t& next = distance_[(cell + offset) * kGridCells + goal];
        if (maze.wall[cell + offset] || next != kUnreachable) continue;
        next = uint8_t(distance_[cell * kGridCells + goal] + 1);
        queue.push_back(uint8_t(cell + offset));
      }
    }
    for (const uint8_t from : maze.free_cells)
      for (int move = 3; move >= 0; --move)
        if (!maze.wall[from + offsets[move]] && distance(from + offsets[move], goal) + 1 == distance(from, goal))
          first_move_[from * kGridCells + goal] = uint8_t(move);
  }
}

int Planner::steps_to_success(const Task& task, const GridState& state) const {
  const auto& cells = state.now.treasures;
  if (state.picked >= 2) return 0;
  if (state.picked == 1) return distance(state.now.agent, cells[task.second]) + 1;
  return distance(state.now.agent, cells[task.first]) + 1 + distance(cells[task.first], cells[task.second]) + 1;
}

int Planner::value_cents(const Task& task, const GridState& state) const {
  const int left = state.picked == 0 ? kFirstPick + kLastPick : state.picked == 1 ? kLastPick : 0;
  return left + kStep * steps_to_success(task, state);
}

std::array<int, kGridActions> Planner::q_cents(const Task& task, const GridState& state) const {
  std::array<int, kGridActions> q;
  for (int action = 0; action < kGridActions; ++action) {
    GridState next = state;
    const WorldStep step = grid_step(*maze_, task, next, action);
    q[action] = step.reward_cents + (step.terminated ? 0 : value_cents(task, next));
  }
  return q;
}

int Planner::action(const Task& task, const GridState& state) const {
  return first_move_[state.now.agent * kGridCells + state.now.treasures[next_target(task, state)]];
}

}  // namespace synpo
