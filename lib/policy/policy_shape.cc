#include "policy/policy_shape.h"

#include <cstddef>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {

constexpr int64_t kSizeLimit = 65536;  // in a checkpoint

// Those that the world decides.
constexpr std::pair<const char*, int PolicyShape::*> kWorldSizes[] = {
    {"envs", &PolicyShape::envs}, {"tasks", &PolicyShape::tasks}, {"actions", &PolicyShape::actions}};
struct ViewSizeName {
  const char* name;
  int TemporalSizes::*member;
};
constexpr ViewSizeName kViewSizes[] = {{"view_channels", &TemporalSizes::channels},
                                       {"object_embedding", &TemporalSizes::object_embedding},
                                       {"view_hidden", &TemporalSizes::hidden}};
struct SwitchName {
  const char* name;
  bool PolicyShape::*member;
};
constexpr SwitchName kSwitches[] = {{"normalise_input", &PolicyShape::normalise_input},
                                    {"normalise_embeddings", &PolicyShape::normalise_embeddings}};

}  // namespace

const std::vector<PolicySize>& policy_sizes() {
  static const std::vector<PolicySize> sizes = {
      {"feature", &PolicyShape::feature, 1, 4096, "size d of the state feature; kitchens: 256"},
      {"basis", &PolicyShape::basis, 1, 4096, "number K of basis policies"},
      {"embedding", &PolicyShape::embedding, 1, 4096, "size of the embeddings"},
      {"hidden", &PolicyShape::hidden, 1, 16384, "hidden units of alpha, beta, f_env and f_task"},
      {"action_embedding", &PolicyShape::action_embedding, 0, 4096, "size of learned phi(a); 0: phi(a) is one-hot",
       true},
      {"head_hidden", &PolicyShape::head_hidden, 1, 16384, "hidden units of their own parts", true},
      {"seam", &PolicyShape::seam, 1, 4096, "size of what a task's module hands on", true}};
  return sizes;
}

std::map<std::string, int64_t> describe_shape(const PolicyShape& shape) {
  std::map<std::string, int64_t> sizes;
  for (const auto& [name, member] : kWorldSizes) sizes[name] = shape.*member;
  for (const PolicySize& size : policy_sizes()) sizes[size.name] = shape.*size.member;
  sizes["sf_loss"] = int64_t(shape.sf_loss);
  for (const SwitchName& flag : kSwitches) sizes[flag.name] = shape.*flag.member;
  if (shape.observation.sight == Sight::kFeatures) {
    sizes["view"] = shape.observation.view;
    sizes["objects"] = shape.observation.objects;
    for (const ViewSizeName& size : kViewSizes) sizes[size.name] = shape.views.*size.member;
  } else {
    for (size_t i = 0; i < shape.channels.size(); ++i) sizes["channels" + std::to_string(i + 1)] = shape.channels[i];
  }
  return sizes;
}

PolicyShape parse_shape(const std::map<std::string, int64_t>& sizes) {
  const auto get = [&](const std::string& name, int64_t low, int64_t high) {
    const auto found = sizes.find(name);
    if (found == sizes.end()) fail(Exit::kData, "the shape has no '", name, "'");
    if (found->second < low || found->second > high)
      fail(Exit::kData, "shape '", name, "': found ", found->second, ", expected a whole number from ", low, " to ",
           high);
    return int(found->second);
  };
  PolicyShape shape;
  for (const auto& [name, member] : kWorldSizes) shape.*member = get(name, 1, kSizeLimit);
  for (const PolicySize& size : policy_sizes())
    if (!size.late || sizes.count(size.name)) shape.*size.member = get(size.name, size.low, kSizeLimit);
  if (sizes.count("sf_loss")) shape.sf_loss = SfLoss(get("sf_loss", 0, 2));
  for (const SwitchName& flag : kSwitches) shape.*flag.member = get(flag.name, 0, 1) != 0;
  if (sizes.count("view")) {
    shape.observation.sight = Sight::kFeatures;
    shape.observation.view = get("view", 1, kSizeLimit);
    shape.observation.objects = get("objects", 1, kSizeLimit);
    for (const ViewSizeName& size : kViewSizes) shape.views.*size.member = get(size.name, 1, kSizeLimit);
  } else {
    for (size_t i = 0; i < shape.channels.size(); ++i)
      shape.channels[i] = get("channels" + std::to_string(i + 1), 1, 4096);
  }
  return shape;
}

}  // namespace synpo
