#include "world/grid_set.h"

#include <set>

#include "base/error.h"

namespace synpo {

GridSet::GridSet(std::vector<Maze> mazes) : mazes_(std::move(mazes)) {
  std::set<std::string> names;
  for (const Maze& maze : mazes_) {
    if (!names.insert(maze.name).second) fail(Exit::kData, "two environments are named ", quoted(maze.name));
    planners_.emplace_back(maze);
  }
}

GridSet GridSet::open(const std::string& world) {
  constexpr char kWorld[] = "gridworld";
  if (world == kWorld) return GridSet(builtin_mazes());
  const std::string prefix = std::string(kWorld) + ":";
  if (world.starts_with(prefix)) return GridSet(load_mazes(world.substr(prefix.size())));
  fail(Exit::kUsage, "unknown world ", quoted(world), ", expected 'gridworld' or 'gridworld:DIR'");
}

int GridSet::env_index(const std::string& name) const {
  for (int i = 0; i < envs(); ++i)
    if (mazes_[i].name == name) return i;
  return -1;
}

int GridSet::task_index(const std::string& name) const {
  for (int i = 0; i < task_count(); ++i)
    if (tasks()[i].name() == name) return i;
  return -1;
}

}  // namespace synpo
