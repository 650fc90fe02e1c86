// A policy together with its weights and the world it was made for: what a checkpoint holds.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "engine/device.h"
#include "engine/engine.h"
#include "format/checkpoint.h"
#include "format/safetensors.h"
#include "nn/buffer.h"
#include "nn/layout.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"
#include "world/world.h"

namespace synpo {

struct Model {
  std::string method;
  PolicyShape shape;
  int window = 1;
  std::vector<EnvTask> seen;
  uint64_t seed = 0;
  int64_t updates = 0, states = 0;
  std::unique_ptr<Policy<float>> policy;
  std::unique_ptr<Engine> engine;  // computes with the policy; the CPU's where nothing else is said
  Buffer<float> parameters, statistics;

  bool is_seen(EnvTask pair) const;
  bool knows(EnvTask pair) const;  // whether its environment and its task are in seen pairs: if not, it is new
};

// Fresh weights; the window is 1 and no pair is seen.
Model fresh_model(const std::string& method, const PolicyShape& shape, const InitOptions& options);

// The policy is computed there from now on. Throws as make_engine().
void compute_on(const DeviceOptions& device, const Parallel& parallel, Model& model);

// Whether some of its environments lie in files of their own.
bool lies_in_files(const Checkpoint& checkpoint);
// The world in the checkpoint; environments that it does not hold itself are taken from `source`. Throws kData where
// they are not there, are other ones, or don't fit this build, kUsage where there is no source.
std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const World* source = nullptr);
// The same with the name of a world to open as the source, which may be empty. Throws kUsage (kNeedsNoSource) where a
// checkpoint that holds its environments is given one with another environment than those.
constexpr Cause kNeedsNoSource{"a source for environments that the checkpoint holds"};
std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const std::string& source);
// Throws kData when tensors or world don't fit, or features come from another extractor.
Model load_model(const Checkpoint& checkpoint, const World& world);

// Puts an array laid out as `layout` into the file, a tensor each, names with `prefix` in front; and back, where all
// are there and have their shapes: kData otherwise.
void add_tensors(SafeTensors& file, const std::string& prefix, const Layout& layout, const float* values);
void check_tensors(const SafeTensors& file, const std::string& prefix, const Layout& layout);
void get_tensors(const SafeTensors& file, const std::string& prefix, const Layout& layout, float* values);

// Everything but the tensors.
Checkpoint describe_model(const Model& model, const World& world);

}  // namespace synpo
