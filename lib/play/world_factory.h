// The worlds by name. A new world has a row in world_factory.cc.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "world/world.h"

namespace synpo {

// Environments that lie in files of their own are asked for without a source, or with one that has no files.
constexpr Cause kNoSource{"no source of environments"}, kOtherSource{"a source without files"};

// As the command line has them; NAME:DIR reads the environments from the files of a folder.
const std::vector<std::string>& world_names();
// Without the folders: for completions.
std::vector<std::string> world_kinds();
// The world of one of these names. Throws kUsage for another, kData and kNoInput for what is wrong with its files.
std::unique_ptr<World> open_world(const std::string& name);
// A world by its name() from environments() as a file has kept them; those without content are taken from `source` by
// their names. Throws kData where content is malformed, or where hashes differ, and kUsage (kNoSource,
// kOtherSource) where there is no source for them.
std::unique_ptr<World> restore_world(const std::string& name, const std::vector<Environment>& environments,
                                     const World* source = nullptr);

}  // namespace synpo
