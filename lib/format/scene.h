// Scenes: kitchens with the features of their views, a safetensors file each (synpo-scene(5)). Here they are arrays
// whose sizes and ranges fit; lib/world/kitchen/recorded_kitchens.h says what the numbers mean.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/files/io.h"

namespace synpo {

constexpr int kSceneVersion = 1;
constexpr int kSceneObjects = 7, kSceneReceptacles = 3, kSceneDoors = 4, kSceneMoves = 5, kSceneFeatures = 2048;
constexpr int kSceneLimit = 65535;  // poses, layouts

// With P poses and L layouts of the objects:
struct Scene {
  std::string env;        // the kitchen's name
  int rules = 1;          // version of the world's rules
  std::string extractor;  // what made the features, and a hash that others of its name do not have
  uint64_t extractor_hash = 0;
  std::vector<int32_t> poses;                // [P, 4] row, column, heading, horizon
  std::vector<int32_t> starts;               // of the poses, ascending
  std::vector<int32_t> next;                 // [P, kSceneMoves] poses
  std::vector<int32_t> objects;              // [L, kSceneObjects, 2] row, column
  std::vector<int32_t> object_distance;      // [L, kSceneDoors, P, kSceneObjects] millimetres, -1 where not visible
  std::vector<int32_t> receptacle_distance;  // [L, kSceneDoors, P, kSceneReceptacles] likewise
  std::vector<int32_t> view;                 // [L, kSceneDoors, P, kSceneObjects + 1] rows of `features`, -1: no row
  bool halves = true;                        // features are F16, else F32
  std::string features;                      // [N, kSceneFeatures], as the file has it

  size_t pose_count() const { return poses.size() / 4; }
  size_t layout_count() const { return objects.size() / (kSceneObjects * 2); }
  // Names the content: of all metadata but format and version, and all tensors.
  uint64_t hash() const;
};

// Throws kData, naming file, tensor and what was found and expected.
Scene read_scene(Input& input);
std::string format_scene(const Scene& scene);

}  // namespace synpo
