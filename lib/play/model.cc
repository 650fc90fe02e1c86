#include "play/model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.h"
#include "engine/cpu_engine.h"
#include "format/pairs.h"
#include "play/episode.h"
#include "play/world_factory.h"
#include "policy/method/registry.h"
#include "world/observation.h"

namespace synpo {

namespace {

void check_holds(const Checkpoint& checkpoint, const World& world, const std::string& name) {
  const auto differs = [&](const auto&... how) {
    fail(Exit::kUsage, kNeedsNoSource, "the checkpoint holds its environments, ", how...);
  };
  if (world.name() != checkpoint.world)
    differs("which are of ", quoted(checkpoint.world), ", but found ", quoted(name));
  for (const Environment& env : world.environments()) {
    const auto held = std::find_if(checkpoint.envs.begin(), checkpoint.envs.end(),
                                   [&](const Checkpoint::Env& one) { return one.name == env.name; });
    if (held == checkpoint.envs.end()) differs("and ", quoted(env.name), " of ", quoted(name), " is none of them");
    if (held->hash != env.hash) differs("and its ", quoted(env.name), " is not the one of ", quoted(name));
  }
}

std::unique_ptr<World> restored_world(const Checkpoint& checkpoint, const World* source) {
  if (checkpoint.envs.empty()) fail(Exit::kData, "the checkpoint has no environment");
  std::vector<Environment> environments;
  for (const Checkpoint::Env& env : checkpoint.envs) environments.push_back({env.name, env.hash, env.content});
  std::unique_ptr<World> world = restore_world(checkpoint.world, environments, source);
  if (checkpoint.rules != world->rules())
    fail(Exit::kData, "rules version ", checkpoint.rules, ", this build has ", world->rules());
  if (checkpoint.tasks != world->task_names()) fail(Exit::kData, "the checkpoint's tasks are not this build's");
  return world;
}

Model loaded_model(const Checkpoint& checkpoint, const World& world) {
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
  model.seen = resolve_pairs(world, rows, false, "metadata 'seen'");
  model.policy = make_policy(model.method, model.shape);
  model.engine = std::make_unique<CpuEngine>(*model.policy);
  // Before memory is taken for what a file only claims to hold.
  for (const Layout* layout : {&model.policy->parameters(), &model.policy->statistics()})
    check_tensors(checkpoint.file, "", *layout);
  get_tensors(checkpoint.file, "", model.policy->parameters(),
              model.parameters.grow(model.policy->parameters().total()));
  get_tensors(checkpoint.file, "", model.policy->statistics(),
              model.statistics.grow(model.policy->statistics().total()));
  return model;
}

}  // namespace

bool Model::is_seen(EnvTask pair) const { return std::find(seen.begin(), seen.end(), pair) != seen.end(); }

bool Model::knows(EnvTask pair) const {
  const auto any = [&](int EnvTask::*side) {
    return std::any_of(seen.begin(), seen.end(), [&](const EnvTask& one) { return one.*side == pair.*side; });
  };
  return any(&EnvTask::env) && any(&EnvTask::task);
}

Model fresh_model(const std::string& method, const PolicyShape& shape, const InitOptions& options) {
  Model model;
  model.method = method;
  model.shape = shape;
  model.seed = options.seed;
  model.policy = make_policy(method, shape);
  model.engine = std::make_unique<CpuEngine>(*model.policy);
  model.parameters.grow(model.policy->parameters().total());
  model.statistics.grow(model.policy->statistics().total());
  model.statistics.zero();
  model.policy->initialise(options, model.parameters.data(), model.statistics.data());
  return model;
}

void compute_on(const DeviceOptions& device, const Parallel& parallel, Model& model) {
  model.engine = make_engine(device, parallel, model.method, model.shape, *model.policy);
}

bool lies_in_files(const Checkpoint& checkpoint) {
  return std::any_of(checkpoint.envs.begin(), checkpoint.envs.end(),
                     [](const Checkpoint::Env& env) { return env.content.empty(); });
}

std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const std::string& source) {
  if (source.empty()) return world_of(checkpoint);
  const std::unique_ptr<World> opened = open_world(source);
  if (lies_in_files(checkpoint)) return world_of(checkpoint, opened.get());
  check_holds(checkpoint, *opened, source);
  return world_of(checkpoint);
}

std::unique_ptr<World> world_of(const Checkpoint& checkpoint, const World* source) {
  return naming_file(checkpoint, [&] { return restored_world(checkpoint, source); });
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
  return naming_file(checkpoint, [&] { return loaded_model(checkpoint, world); });
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
