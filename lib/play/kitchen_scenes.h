// Scenes (format/scene.h) as kitchens (world/kitchen/recorded_kitchens.h), and scenes of kitchens that have a plan.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "format/scene.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/recorded_kitchens.h"
#include "world/kitchen/view/view.h"

namespace synpo {

constexpr const char* kSceneEnding = ".scene.safetensors";

// Throws kData for a scene of other rules.
RecordedKitchen to_kitchen(Scene scene);
// Every scene of a folder, by file names in natural order. Throws kNoInput when there is none.
std::vector<RecordedKitchen> read_kitchens(const std::string& folder);

// Features in two steps, so that those of equal pictures are computed once.
struct PictureFeatures {
  std::string name;  // of the extractor
  uint64_t hash;
  size_t picture_bytes;
  std::function<void(const KitchenSolids& solids, const KitchenFrame& frame, uint8_t* picture)>
      draw;  // from several threads
  // The features [count, kViewFeatures] of pictures [count, picture_bytes].
  std::function<void(const uint8_t* pictures, int count, float* features)> extract;
};

using ObjectSlots = std::array<uint8_t, kKitchenObjects>;
// Layouts that differ, drawn at random; they do not depend on how many more are drawn.
std::vector<ObjectSlots> random_layouts(const KitchenSet& world, int env, int count, uint64_t seed);
// The scene of a kitchen with the objects on these slots; features are stored as Half. `done` is told how many of how
// many poses are done. Throws kData for features that Half cannot hold.
Scene make_scene(Parallel& parallel, const KitchenSet& world, int env, const std::vector<ObjectSlots>& layouts,
                 const PictureFeatures& features, const std::function<void(size_t done, size_t total)>& done);

}  // namespace synpo
