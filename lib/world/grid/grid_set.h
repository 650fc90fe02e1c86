// GridWorld as a World: mazes, their planners, and tasks.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/random.h"
#include "world/grid/maze.h"
#include "world/grid/planner.h"
#include "world/grid/task.h"
#include "world/world.h"

namespace synpo {

class GridSet : public World {
 public:
  // Throws kData for two mazes of one name.
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

  WorldState reset(int env, Random& random) const override;
  WorldStep step(EnvTask pair, WorldState& state, int action) const override;
  int expert(EnvTask pair, const WorldState& state) const override;
  void action_values(EnvTask pair, const WorldState& state, int* cents) const override;
  bool at_choice(EnvTask pair, const WorldState& state) const override;

  // `window` is the radius of what is seen.
  void observe(int env, const StateHistory& history, int window, uint8_t* observation) const override;

  StartPlaces start_places(int env, const WorldState& start) const override;
  WorldState start_state(int env, const StartPlaces& places) const override;
  bool valid(EnvTask pair, const WorldState& state) const override;

 private:
  const Task& task(EnvTask pair) const { return tasks()[pair.task]; }
  std::vector<Maze> mazes_;
  std::vector<Planner> planners_;
};

// The world as what it is. Throws kUsage, naming `what` for it is needed, for another.
const GridSet& as_gridworld(const World& world, const std::string& what);

}  // namespace synpo
