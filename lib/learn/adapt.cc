#include "learn/adapt.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/take_rows.h"
#include "engine/cpu_engine.h"
#include "learn/finite.h"
#include "nn/init.h"
#include "nn/layout.h"
#include "play/running_episode.h"
#include "policy/method/registry.h"
#include "policy/policy.h"

namespace synpo {
namespace {

const TensorInfo& table(const Policy<float>& policy, PairSide side) {
  const TensorInfo* tensor = policy.embeddings(side);
  if (!tensor)
    fail(Exit::kUsage, "the method has no tensor 'embedding.", side == PairSide::kEnv ? "env" : "task",
         "': nothing to adapt");
  return *tensor;
}

}  // namespace

Model widen(const Model& model, const World& from, const World& world, double embedding_sd, uint64_t seed) {
  if (const BatchNeeds needs = model.policy->needs(); needs.next || needs.planner_q)
    fail(Exit::kUsage, kNeedsMore, "the loss that the policy was trained with needs more than demonstrations hold");
  Model wide;
  wide.method = model.method;
  wide.shape = model.shape;
  wide.shape.envs = world.envs();
  wide.window = model.window;
  wide.seed = model.seed;
  wide.updates = model.updates;
  wide.states = model.states;
  wide.policy = make_policy(wide.method, wide.shape);
  wide.engine = std::make_unique<CpuEngine>(*wide.policy);
  std::vector<int> place(from.envs());  // of an old environment in the new world
  for (int env = 0; env < from.envs(); ++env) {
    const Environment& old = from.environments()[env];
    place[env] = world.env_index(old.name);
    if (place[env] < 0 || world.environments()[place[env]].hash != old.hash)
      fail(Exit::kData, "environment ", quoted(old.name), " is another one in the checkpoint");
  }
  std::vector<bool> old_env(world.envs(), false), old_task(world.task_count(), false);
  for (const EnvTask& pair : model.seen) {
    wide.seen.push_back({place[pair.env], pair.task});
    old_env[place[pair.env]] = old_task[pair.task] = true;
  }
  const Layout &before = model.policy->parameters(), &after = wide.policy->parameters();
  wide.parameters.grow(after.total());
  wide.parameters.zero();
  wide.statistics.grow(wide.policy->statistics().total());
  std::copy_n(model.statistics.data(), wide.policy->statistics().total(), wide.statistics.data());
  const TensorInfo &envs = table(*wide.policy, PairSide::kEnv), &tasks = table(*wide.policy, PairSide::kTask);
  for (const TensorInfo& tensor : after.tensors())
    if (tensor.name != envs.name)
      std::copy_n(model.parameters.data() + before.find(tensor.name)->offset, tensor.size,
                  wide.parameters.data() + tensor.offset);
  const int width = wide.shape.embedding;
  for (int env = 0; env < from.envs(); ++env)
    std::copy_n(model.parameters.data() + before.find(envs.name)->offset + size_t(env) * width, width,
                wide.parameters.data() + envs.offset + size_t(place[env]) * width);
  InitStream stream(seed, 3);
  const auto renew = [&](const TensorInfo& rows, const std::vector<bool>& old) {
    for (size_t row = 0; row < old.size(); ++row) {
      if (old[row]) continue;
      float* values = wide.parameters.data() + rows.offset + row * width;
      if (embedding_sd > 0)
        stream.normal(values, width, embedding_sd);
      else
        stream.uniform(values, width, xavier_bound(int(old.size()), width));
    }
  };
  renew(envs, old_env);
  renew(tasks, old_task);
  return wide;
}

Adaptation::Adaptation(const World& world, Parallel& parallel, Model model, const AdaptOptions& options, uint64_t seed)
    : world_(world), parallel_(parallel), model_(std::move(model)), options_(options), seed_(seed),
      new_env_(world.envs(), true), new_task_(world.task_count(), true) {
  for (const EnvTask& pair : model_.seen) new_env_[pair.env] = new_task_[pair.task] = false;
  learned_ = learned();
  for (Buffer<float>* buffer : {&gradient_, &first_moment_, &second_moment_}) {
    buffer->grow(model_.parameters.size());
    buffer->zero();
  }
}

int Adaptation::new_envs() const { return int(std::count(new_env_.begin(), new_env_.end(), true)); }
int Adaptation::new_tasks() const { return int(std::count(new_task_.begin(), new_task_.end(), true)); }

std::vector<Adaptation::Span> Adaptation::learned() const {
  std::vector<Span> spans;
  const size_t width = size_t(model_.shape.embedding);
  const auto add_rows = [&](const TensorInfo& tensor, const std::vector<bool>& rows) {
    for (size_t row = 0; row < rows.size(); ++row) {
      const size_t offset = tensor.offset + row * width;
      if (!rows[row]) continue;
      if (!spans.empty() && spans.back().offset + spans.back().size == offset)
        spans.back().size += width;
      else
        spans.push_back({offset, width});
    }
  };
  add_rows(table(*model_.policy, PairSide::kEnv), new_env_);
  add_rows(table(*model_.policy, PairSide::kTask), new_task_);
  const auto add_group = [&](ParameterGroup group) {
    for (const TensorInfo* tensor : model_.policy->group(group)) spans.push_back({tensor->offset, tensor->size});
  };
  if (options_.targets.basis) add_group(ParameterGroup::kHeads);
  if (options_.targets.recognisers) add_group(ParameterGroup::kRecognisers);
  if (options_.targets.coefficients) add_group(ParameterGroup::kCoefficients);
  return spans;
}

void Adaptation::add(const Episode& episode) {
  const size_t size = world_.observation_size();
  if ((env_.size() + episode.actions.size()) * size > options_.most_bytes)
    fail(Exit::kData, "the demonstrations have more than ", options_.most_bytes / size,
         " steps, as many as there is room for: give fewer of them");
  if (!model_.is_seen(episode.pair)) model_.seen.push_back(episode.pair);
  RunningEpisode running;
  running.start(episode.pair, episode.start);
  for (size_t t = 0; t < episode.actions.size(); ++t) {
    observations_.resize(observations_.size() + size);
    running.observe(world_, model_.window, observations_.data() + observations_.size() - size);
    env_.push_back(episode.pair.env);
    task_.push_back(episode.pair.task);
    label_.push_back(episode.labels[t]);
    taken_.push_back(episode.actions[t]);
    reward_.push_back(float(running.step(world_, episode.actions[t]).reward_cents) / 100);
  }
  first_.push_back(env_.size());
}

void Adaptation::compute_features() {
  const int d = model_.shape.feature, steps = int(env_.size()), done = int(psi_.size() / size_t(d));
  if (done == steps) return;
  psi_.resize(size_t(steps) * d);
  model_.engine->prepare_inference(parallel_, model_.parameters.data(), model_.statistics.data(), {{0, 0}});
  const int unit = model_.engine->inference_unit();
  parallel_.run(shard_count(steps - done, unit), [&](int shard, int thread) {
    const Range range = shard_range(steps - done, unit, shard);
    const size_t at = size_t(done) + range.begin;
    const std::vector<int> pair(range.size(), 0);
    std::vector<float> logits(size_t(range.size()) * world_.actions());
    model_.engine->infer(thread, range.size(), observations_.data() + at * world_.observation_size(), pair.data(),
                         logits.data(), psi_.data() + at * d);
  });
}

bool Adaptation::has_embedding_loss() const {
  const size_t step_bytes = model_.policy->embedding_loss_step_bytes();
  return step_bytes > 0 && !options_.targets.basis && !options_.targets.coefficients &&
         env_.size() <= options_.memory_bytes / step_bytes;
}

void Adaptation::extend_embedding_loss() {
  if (!embedding_loss_)
    embedding_loss_ =
        model_.policy->embedding_loss(model_.parameters.data(), new_env_, new_task_, options_.targets.recognisers);
  std::vector<EmbeddingLoss::Steps> episodes;
  for (size_t i = embedding_loss_->episodes(); i < demonstrations(); ++i) {
    const size_t at = first_[i];
    episodes.push_back({{env_[at], task_[at]},
                        int(first_[i + 1] - at),
                        psi_.data() + at * model_.shape.feature,
                        label_.data() + at,
                        taken_.data() + at,
                        reward_.data() + at});
  }
  embedding_loss_->add(parallel_, episodes);
}

Losses Adaptation::through_head(const std::vector<size_t>& drawn) {
  std::vector<size_t> rows;
  for (const size_t episode : drawn)
    for (size_t row = first_[episode]; row < first_[episode + 1]; ++row) rows.push_back(row);
  const int n = int(rows.size());
  const std::vector<int> env = gathered(env_, rows), task = gathered(task_, rows), label = gathered(label_, rows),
                         taken = gathered(taken_, rows);
  const std::vector<float> reward = gathered(reward_, rows), psi = gathered(psi_, rows, size_t(model_.shape.feature));
  logits_.resize(size_t(n) * world_.actions());
  const StepBatch<float> batch = {.size = n,
                                  .env = env.data(),
                                  .task = task.data(),
                                  .label = label.data(),
                                  .taken = taken.data(),
                                  .reward = reward.data(),
                                  .psi = psi.data()};
  return model_.engine->step(parallel_, batch, {options_.losses}, model_.parameters.data(), model_.statistics.data(),
                             gradient_.data(), logits_.data());
}

Losses Adaptation::update() {
  if (demonstrations() == 0) fail(Exit::kData, "no demonstration to adapt from");
  compute_features();
  Random random(seed_, Purpose::kBatch, 0, uint64_t(updates_));
  std::vector<size_t> drawn;
  for (int i = 0; i < options_.trajectories; ++i) drawn.push_back(random.below(uint32_t(demonstrations())));
  Losses losses;
  if (has_embedding_loss()) {
    extend_embedding_loss();
    losses = embedding_loss_->step(parallel_, drawn, options_.losses, model_.parameters.data(), gradient_.data());
  } else {
    losses = through_head(drawn);
  }
  check_finite(losses.total, updates_ + 1);
  ++updates_;
  for (const Span& span : learned_)
    adam_step(parallel_, options_.adam, updates_, span.size, gradient_.data() + span.offset,
              model_.parameters.data() + span.offset, first_moment_.data() + span.offset,
              second_moment_.data() + span.offset);
  return losses;
}

Checkpoint Adaptation::checkpoint(std::map<std::string, std::string> options) const {
  Checkpoint c = describe_model(model_, world_);
  c.options = std::move(options);
  c.options["adapt.updates"] = concat(updates_);
  c.options["adapt.demonstrations"] = concat(demonstrations());
  add_tensors(c.file, "", model_.policy->parameters(), model_.parameters.data());
  add_tensors(c.file, "", model_.policy->statistics(), model_.statistics.data());
  return c;
}

}  // namespace synpo
