// The expert of GridWorld: exact shortest paths between all cells of a maze, computed once.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"

namespace synpo {

class Planner {
 public:
  explicit Planner(const Maze& maze);

  // Steps from one free cell to another.
  int distance(int from, int to) const { return distance_[from * kGridCells + to]; }
  // Undiscounted return in hundredths of taking each action now and acting optimally after, without the step limit.
  std::array<int, kGridActions> q_cents(const Task& task, const GridState& state) const;
  // The best action; ties go to the first in the order of the actions.
  int action(const Task& task, const GridState& state) const;
  // Steps of the expert's episode from here to success.
  int steps_to_success(const Task& task, const GridState& state) const;

 private:
  int value_cents(const Task& task, const GridState& state) const;
  const Maze* maze_;
  std::vector<uint8_t> distance_;    // [256, 256]; 255 where a wall is in the way
  std::vector<uint8_t> first_move_;  // [256, 256], the expert's move from one cell towards another; kPick at the goal
};

}  // namespace synpo
