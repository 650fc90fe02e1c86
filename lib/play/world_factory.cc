#include "play/world_factory.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "play/kitchen_scenes.h"
#include "world/grid/grid_set.h"
#include "world/grid/maze.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/recorded_kitchens.h"

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
  const RecordedKitchens* scenes = dynamic_cast<const RecordedKitchens*>(source);
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
  return std::make_unique<RecordedKitchens>(*scenes, chosen);
}

std::unique_ptr<World> open_kitchens(const std::string& name) {
  static const std::string scenes = "kitchen:";
  if (name.starts_with(scenes)) return std::make_unique<RecordedKitchens>(read_kitchens(name.substr(scenes.size())));
  return std::make_unique<KitchenSet>();
}

std::unique_ptr<World> restore_kitchens(const std::vector<Environment>& environments, const World* source) {
  const bool in_files =
      std::any_of(environments.begin(), environments.end(), [](const Environment& env) { return env.content.empty(); });
  if (in_files) return choose_scenes(environments, source);
  return std::make_unique<KitchenSet>(parse_all(environments, parse_kitchen));
}

std::unique_ptr<World> open_grid(const std::string& name) { return std::make_unique<GridSet>(open_mazes(name)); }

std::unique_ptr<World> restore_grid(const std::vector<Environment>& environments, const World*) {
  return std::make_unique<GridSet>(parse_all(environments, parse_maze));
}

struct KindOfWorld {
  const char* name;  // World::name()
  bool has_folders;  // there is NAME:DIR too
  // By the name on the command line.
  std::unique_ptr<World> (*open)(const std::string& name);
  // As restore_world().
  std::unique_ptr<World> (*restore)(const std::vector<Environment>& environments, const World* source);
};

constexpr KindOfWorld kWorlds[] = {{"gridworld", true, open_grid, restore_grid},
                                   {"kitchen", true, open_kitchens, restore_kitchens}};

}  // namespace

const std::vector<std::string>& world_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const KindOfWorld& world : kWorlds) {
      all.push_back(world.name);
      if (world.has_folders) all.push_back(concat(world.name, ":DIR"));
    }
    return all;
  }();
  return names;
}

std::vector<std::string> world_kinds() {
  std::vector<std::string> names;
  for (const KindOfWorld& world : kWorlds) names.emplace_back(world.name);
  return names;
}

std::unique_ptr<World> open_world(const std::string& name) {
  for (const KindOfWorld& world : kWorlds)
    if (name == world.name || (world.has_folders && name.starts_with(concat(world.name, ":")))) return world.open(name);
  fail(Exit::kUsage, "unknown world ", quoted(name), ", expected ", alternatives(world_names()),
       did_you_mean(name, world_names()));
}

std::unique_ptr<World> restore_world(const std::string& name, const std::vector<Environment>& environments,
                                     const World* source) {
  std::string known;
  for (const KindOfWorld& world : kWorlds) {
    if (name == world.name) return world.restore(environments, source);
    known += concat(known.empty() ? "" : " and ", world.name);
  }
  fail(Exit::kData, "world ", quoted(name), ", this build has ", known);
}

}  // namespace synpo
