// The worlds by name.
#include "base/error.h"
#include "world/grid_set.h"
#include "world/kitchen_set.h"

namespace synpo {
namespace {

// Environments of a file, each parsed by `parse(name, content, where)`.
template <class Parse>
auto parse_all(const std::vector<Environment>& environments, Parse parse) {
  std::vector<decltype(parse("", "", ""))> all;
  for (const Environment& env : environments) {
    all.push_back(parse(env.name, env.content, "env " + quoted(env.name)));
    if (all.back().hash != env.hash) fail(Exit::kData, "env ", quoted(env.name), ": content and hash differ");
  }
  return all;
}

}  // namespace

std::unique_ptr<World> open_world(const std::string& name) {
  if (name == "kitchen") return std::make_unique<KitchenSet>();
  if (name == "gridworld" || name.starts_with("gridworld:")) return std::make_unique<GridSet>(open_mazes(name));
  fail(Exit::kUsage, "unknown world ", quoted(name), ", expected gridworld, gridworld:DIR or kitchen");
}

std::unique_ptr<World> restore_world(const std::string& name, const std::vector<Environment>& environments) {
  if (name == "gridworld") return std::make_unique<GridSet>(parse_all(environments, parse_maze));
  if (name == "kitchen") return std::make_unique<KitchenSet>(parse_all(environments, parse_kitchen));
  fail(Exit::kData, "world ", quoted(name), ", this build has gridworld and kitchen");
}

}  // namespace synpo
