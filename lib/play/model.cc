#include "play/model.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "play/world_factory.h"
#include "policy/method/mlp.h"
#include "policy/method/modulenet.h"
#include "policy/method/mtl.h"
#include "policy/method/sf.h"

namespace synpo {
namespace {

constexpr int64_t kSizeLimit = 65536;

struct SizeName {
  const char* name;
  int PolicyShape::*member;
  int low = 1;
  bool late = false;  // checkpoints made before it have its default
};
constexpr SizeName kSizes[] = {{"envs", &PolicyShape::envs},
                               {"tasks", &PolicyShape::tasks},
                               {"actions", &PolicyShape::actions},
                               {"feature", &PolicyShape::feature},
                               {"basis", &PolicyShape::basis},
                               {"embedding", &PolicyShape::embedding},
                               {"hidden", &PolicyShape::hidden},
                               {"action_embedding", &PolicyShape::action_embedding, 0, true},
                               {"head_hidden", &PolicyShape::head_hidden, 1, true},
                               {"seam", &PolicyShape::seam, 1, true}};
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

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = {"synpo", "mlp", "mtl", "modulenet", "sf"};
  return names;
}

template <class T>
std::unique_ptr<Policy<T>> make_policy(const std::string& method, const PolicyShape& shape) {
  if (method == "synpo") return std::make_unique<SynPo<T>>(shape);
  if (method == "mlp") return std::make_unique<Mlp<T>>(shape);
  if (method == "mtl") return std::make_unique<Mtl<T>>(shape);
  if (method == "modulenet") return std::make_unique<ModuleNet<T>>(shape);
  if (method == "sf") return std::make_unique<Sf<T>>(shape);
  fail(Exit::kData, "unknown method ", quoted(method), ", expected ", alternatives(method_names()));
}
template std::unique_ptr<Policy<float>> make_policy(const std::string&, const PolicyShape&);
template std::unique_ptr<Policy<double>> make_policy(const std::string&, const PolicyShape&);

std::map<std::string, int64_t> describe_shape(const PolicyShape& shape) {
  std::map<std::string, int64_t> sizes;
  for (const SizeName& size : kSizes) sizes[size.name] = shape.*size.member;
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
  for (const SizeName& size : kSizes)
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

bool Model::is_seen(EnvTask pair) const { return std::find(seen.begin(), seen.end(), pair) != seen.end(); }

Model fresh_model(const std::string& method, const PolicyShape& shape, const InitOptions& options) {
  Model model;
  model.method = method;
  model.shape = shape;
  model.seed = options.seed;
  model.policy = make_policy(method, shape);
  model.parameters.grow(model.policy->parameters().total());
  model.statistics.grow(model.policy->statistics().total());
  model.statistics.zero();
  model.policy->initialise(options, model.parameters.data(), model.statistics.data());
  return model;
}

bool lies_in_files(const Checkpoint& checkpoint) {
  return std::any_of(checkpoint.envs.begin(), checkpoint.envs.end(),
                     [](const Checkpoint::Env& env) { return env.content.empty(); });
}

std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const std::string& source) {
  if (source.empty()) return world_of(checkpoint);
  if (!lies_in_files(checkpoint))
    fail(Exit::kUsage, "the checkpoint holds its environments: -w is for those that lie in files of their own");
  const std::unique_ptr<World> opened = open_world(source);
  return world_of(checkpoint, opened.get());
}

std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const World* source) {
  if (checkpoint.envs.empty()) fail(Exit::kData, "the checkpoint has no environment");
  std::vector<Environment> environments;
  for (const Checkpoint::Env& env : checkpoint.envs) environments.push_back({env.name, env.hash, env.content});
  std::unique_ptr<World> world = restore_world(checkpoint.world, environments, source);
  if (checkpoint.rules != world->rules())
    fail(Exit::kData, "rules version ", checkpoint.rules, ", this build has ", world->rules());
  if (checkpoint.tasks != world->task_names()) fail(Exit::kData, "the checkpoint's tasks are not this build's");
  return world;
}

void add_tensors(SafeTensors& file, const std::string& prefix, const Layout& layout, const float* values) {
  for (const TensorInfo& tensor : layout.tensors())
    file.add(prefix + tensor.name, {tensor.shape.begin(), tensor.shape.end()}, values + tensor.offset, tensor.size);
}

void check_tensors(const SafeTensors& file, const std::string& prefix, const Layout& layout) {
  const auto text = [](const auto& shape) {
    std::string sizes;
    for (const auto size : shape) sizes += concat(sizes.empty() ? "" : ", ", size);
    return "[" + sizes + "]";
  };
  for (const TensorInfo& tensor : layout.tensors()) {
    const auto found = file.tensors.find(prefix + tensor.name);
    if (found == file.tensors.end()) fail(Exit::kData, "no tensor '", prefix, tensor.name, "'");
    const std::vector<int64_t>& shape = found->second.shape;
    if (!std::equal(shape.begin(), shape.end(), tensor.shape.begin(), tensor.shape.end()))
      fail(Exit::kData, "tensor '", prefix, tensor.name, "': found shape ", text(shape), ", expected ",
           text(tensor.shape));
  }
}

void get_tensors(const SafeTensors& file, const std::string& prefix, const Layout& layout, float* values) {
  check_tensors(file, prefix, layout);
  std::fill_n(values, layout.total(), 0.0f);
  for (const TensorInfo& tensor : layout.tensors()) {
    file.get(prefix + tensor.name, values + tensor.offset, tensor.size);
    for (size_t i = 0; i < tensor.size; ++i)
      if (!std::isfinite(values[tensor.offset + i]))
        fail(Exit::kData, "tensor '", prefix, tensor.name, "' holds a value that is not finite");
  }
}

Model load_model(const Checkpoint& checkpoint, const World& world) {
  Model model;
  model.method = checkpoint.method;
  model.shape = parse_shape(checkpoint.shape);
  const ObservationSpec &said = model.shape.observation, &spec = world.observation_spec();
  if (model.shape.envs != world.envs() || model.shape.tasks != world.task_count() ||
      model.shape.actions != world.actions() || said.sight != spec.sight || said.view != spec.view ||
      said.objects != spec.objects)
    fail(Exit::kData, "the network's shape does not fit the world");
  model.shape.observation = spec;
  if (!checkpoint.extractor.empty() && checkpoint.extractor != world.extractor())
    fail(Exit::kData, "the policy was trained on features of ", quoted(checkpoint.extractor), ", found those of ",
         quoted(world.extractor()));
  model.window = checkpoint.window;
  model.seed = checkpoint.seed;
  model.updates = checkpoint.updates;
  model.states = checkpoint.states;
  std::vector<PairRow> rows;
  for (const auto& [env, task] : checkpoint.seen) rows.push_back({env, task, true, ""});
  model.seen = resolve_pairs(world, rows, false);
  model.policy = make_policy(model.method, model.shape);
  // Before memory is taken for what a file only claims to hold.
  for (const Layout* layout : {&model.policy->parameters(), &model.policy->statistics()})
    check_tensors(checkpoint.file, "", *layout);
  get_tensors(checkpoint.file, "", model.policy->parameters(),
              model.parameters.grow(model.policy->parameters().total()));
  get_tensors(checkpoint.file, "", model.policy->statistics(),
              model.statistics.grow(model.policy->statistics().total()));
  return model;
}

Checkpoint describe_model(const Model& model, const World& world) {
  Checkpoint c;
  c.method = model.method;
  c.world = world.name();
  c.rules = world.rules();
  c.extractor = world.extractor();
  c.window = model.window;
  for (const Environment& env : world.environments()) c.envs.push_back({env.name, env.hash, env.content});
  c.tasks = world.task_names();
  for (const EnvTask& pair : model.seen)
    c.seen.emplace_back(world.environments()[pair.env].name, world.task_names()[pair.task]);
  c.shape = describe_shape(model.shape);
  c.updates = model.updates;
  c.states = model.states;
  c.seed = model.seed;
  return c;
}

}  // namespace synpo
