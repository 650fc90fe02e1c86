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

GridSet GridSet::open(const std::string& world) { return GridSet(open_mazes(world)); }

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
