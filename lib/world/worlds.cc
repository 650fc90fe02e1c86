#include "base/error.h"
#include "world/grid_set.h"

namespace synpo {

std::unique_ptr<World> open_world(const std::string& name) { return std::make_unique<GridSet>(open_mazes(name)); }

std::unique_ptr<World> restore_world(const std::string& name, const std::vector<Environment>& environments) {
  if (name != "gridworld") fail(Exit::kData, "world ", quoted(name), ", this build has gridworld");
  std::vector<Maze> mazes;
  for (const Environment& env : environments) {
    mazes.push_back(parse_maze(env.name, env.content, "env " + quoted(env.name)));
    if (mazes.back().hash != env.hash) fail(Exit::kData, "env ", quoted(env.name), ": content and hash differ");
  }
  return std::make_unique<GridSet>(std::move(mazes));
}

}  // namespace synpo
