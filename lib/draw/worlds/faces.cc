#include "draw/worlds/faces.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "draw/grid/grid_face.h"
#include "draw/kitchen/kitchen_face.h"
#include "world/grid/grid_set.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

struct DrawnWorld {
  std::string name;
  bool has_folders;  // there is NAME:DIR too
  const FaceKind& kind;
  std::shared_ptr<const World> (*open)(const std::string& name);
  // Null for another world.
  std::unique_ptr<const WorldFace> (*face)(const std::shared_ptr<const World>& world);
};

template <class ItsWorld, class ItsFace>
std::unique_ptr<const WorldFace> face_for(const std::shared_ptr<const World>& world) {
  const auto own = std::dynamic_pointer_cast<const ItsWorld>(world);
  return own ? std::make_unique<const ItsFace>(own) : nullptr;
}

std::shared_ptr<const World> open_grid(const std::string& name) {
  return std::make_shared<const GridSet>(GridSet::open(name));
}

std::shared_ptr<const World> open_kitchens(const std::string&) { return std::make_shared<const KitchenSet>(); }

const std::vector<DrawnWorld>& worlds() {
  static const std::vector<DrawnWorld> all = {
      {"gridworld", true, GridFace::kKind, open_grid, face_for<GridSet, GridFace>},
      {"kitchen", false, KitchenFace::kKind, open_kitchens, face_for<KitchenSet, KitchenFace>},
  };
  return all;
}

}  // namespace

std::unique_ptr<const WorldFace> open_face(const std::string& world) {
  for (const DrawnWorld& drawn : worlds()) {
    const bool in_folder = world.starts_with(drawn.name + ":");
    if (in_folder && !drawn.has_folders)
      fail(Exit::kUsage, "cannot draw the world ", quoted(world), ": of the ", drawn.kind.environments,
           ", only those of ", quoted(drawn.name), " have plans");
    if (in_folder || world == drawn.name) return face_of(drawn.open(world));
  }
  fail(Exit::kUsage, "unknown world ", quoted(world), ", expected ", drawn_worlds());
}

std::unique_ptr<const WorldFace> face_of(std::shared_ptr<const World> world) {
  for (const DrawnWorld& drawn : worlds())
    if (std::unique_ptr<const WorldFace> face = drawn.face(world)) return face;
  return std::make_unique<const WorldFace>(std::move(world));
}

std::string drawn_worlds() {
  std::vector<std::string> names;
  for (const DrawnWorld& drawn : worlds()) {
    names.push_back(drawn.name);
    if (drawn.has_folders) names.push_back(drawn.name + ":DIR");
  }
  return alternatives(names);
}

std::string worlds_with(bool FaceKind::*feature) {
  std::vector<std::string> names;
  for (const DrawnWorld& drawn : worlds())
    if (drawn.kind.*feature) names.push_back(drawn.name);
  return alternatives(names);
}

std::string environments_with(bool FaceKind::*feature) {
  std::vector<std::string> names;
  for (const DrawnWorld& drawn : worlds())
    if (drawn.kind.*feature) names.push_back(drawn.kind.environments);
  return alternatives(names);
}

}  // namespace synpo
