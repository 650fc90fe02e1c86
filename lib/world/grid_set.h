// GridWorld as a whole: environments, their planners, and tasks.
#pragma once
#include <string>
#include <vector>

#include "world/planner.h"

namespace synpo {

class GridSet {
 public:
  explicit GridSet(std::vector<Maze> mazes);
  // Copies would leave the planners with the original's mazes.
  GridSet(GridSet&&) = default;
  GridSet& operator=(GridSet&&) = default;

  // By the world's name, as open_mazes() has it.
  static GridSet open(const std::string& world);

  const std::vector<Maze>& mazes() const { return mazes_; }
  const Maze& maze(int env) const { return mazes_[env]; }
  const Planner& planner(int env) const { return planners_[env]; }
  const std::vector<Task>& tasks() const { return grid_tasks(); }
  int envs() const { return int(mazes_.size()); }
  int task_count() const { return int(tasks().size()); }
  // Position of a name, or -1.
  int env_index(const std::string& name) const;
  int task_index(const std::string& name) const;
  // Number of a pair, for random streams.
  uint64_t pair_number(int env, int task) const { return uint64_t(env) * tasks().size() + task; }

 private:
  std::vector<Maze> mazes_;
  std::vector<Planner> planners_;
};

}  // namespace synpo
