#include "play/world_factory.h"

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "play/kitchen_scenes.h"
#include "world/grid/grid_set.h"
#include "world/kitchen/kitchen_set.h"

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

std::unique_ptr<World> choose_scenes(const std::vector<Environment>& environments, const World* source) {
  if (!source) fail(Exit::kUsage, kNoSource, "the kitchens lie in files of their own");
  const SceneKitchens* scenes = dynamic_cast<const SceneKitchens*>(source);
  if (!scenes)
    fail(Exit::kUsage, kOtherSource, "the kitchens lie in files of their own: found the built-in ",
         quoted(source->name()));
  std::vector<int> chosen;
  for (const Environment& env : environments) {
    const int found = scenes->env_index(env.name);
    if (found < 0) fail(Exit::kData, "env ", quoted(env.name), ": no scene of that name in the folder");
    const uint64_t hash = scenes->environments()[size_t(found)].hash;
    if (hash != env.hash)
      fail(Exit::kData, "env ", quoted(env.name), ": found a scene with hash ", hex(hash), ", expected ",
           hex(env.hash));
    chosen.push_back(found);
  }
  return std::make_unique<SceneKitchens>(*scenes, chosen);
}

}  // namespace

std::unique_ptr<World> open_world(const std::string& name) {
  static const std::string scenes = "kitchen:";
  if (name == "kitchen") return std::make_unique<KitchenSet>();
  if (name.starts_with(scenes)) return std::make_unique<SceneKitchens>(read_kitchens(name.substr(scenes.size())));
  if (name == "gridworld" || name.starts_with("gridworld:")) return std::make_unique<GridSet>(open_mazes(name));
  fail(Exit::kUsage, "unknown world ", quoted(name), ", expected ", kWorldNames);
}

std::unique_ptr<World> restore_world(const std::string& name, const std::vector<Environment>& environments,
                                     const World* source) {
  if (name == "gridworld") return std::make_unique<GridSet>(parse_all(environments, parse_maze));
  if (name != "kitchen") fail(Exit::kData, "world ", quoted(name), ", this build has gridworld and kitchen");
  const bool in_files =
      std::any_of(environments.begin(), environments.end(), [](const Environment& env) { return env.content.empty(); });
  if (in_files) return choose_scenes(environments, source);
  return std::make_unique<KitchenSet>(parse_all(environments, parse_kitchen));
}

}  // namespace synpo
