#include "learn/ppo/ppo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/take_rows.h"
#include "format/safetensors.h"
#include "learn/finite.h"
#include "nn/init.h"
#include "nn/softmax.h"
#include "play/episode_batch.h"
#include "policy/losses.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

Ppo::Ppo(const World& world, Parallel& parallel, Model model, const PpoOptions& options, uint64_t seed)
    : world_(world), parallel_(parallel), options_(options), seed_(seed), model_(std::move(model)),
      actors_(world, model_.seen, options.lanes, seed) {
  if (size() % options_.minibatches != 0)
    fail(Exit::kUsage, size(), " steps of a rollout cannot be cut into ", options_.minibatches, " minibatches");
  value_ = std::make_unique<ValueFunction>(model_.shape, *model_.policy, options_.value_hidden);
  value_parameters_.assign(value_->parameters().total(), 0);
  value_v_.assign(value_->parameters().total(), 0);
  InitStream stream(seed, 2);
  value_->initialise(stream, value_parameters_.data());
  v_.grow(model_.parameters.size());
  v_.zero();
}

void Ppo::measure_statistics(int batches) {
  const int actions = world_.actions();
  std::vector<float> logits, gradient(model_.parameters.size());
  for (int batch = 0; batch < batches; ++batch) {
    const int n = 512;
    std::vector<uint8_t> observations(n * world_.observation_size());
    std::vector<int> env(n), task(n), action(n);
    const std::vector<float> reward(n, 0);
    Random random(seed_, Purpose::kStatisticsMove, 0, uint64_t(batch));
    for (int i = 0; i < n; ++i) {
      const int actor = i % actors_.count();
      const RunningEpisode& episode = actors_.episodes()[actor];
      episode.observe(world_, model_.window, observations.data() + i * world_.observation_size());
      env[i] = episode.pair.env;
      task[i] = episode.pair.task;
      action[i] = int(random.below(uint32_t(actions)));
      if (actors_.step(actor, action[i]).ended()) actors_.restart(actor);
    }
    logits.resize(size_t(n) * actions);
    const StepBatch<float> steps = {.size = n,
                                    .observations = observations.data(),
                                    .env = env.data(),
                                    .task = task.data(),
                                    .label = action.data(),
                                    .taken = action.data(),
                                    .reward = reward.data()};
    model_.engine->step(parallel_, steps, {}, model_.parameters.data(), model_.statistics.data(), gradient.data(),
                        logits.data());
  }
  actors_.take_finished();
}

void Ppo::look(const std::vector<int>& actors, uint8_t* observations, float* logits, float* psi, float* values) {
  const int n = int(actors.size()), d = model_.shape.feature, actions = world_.actions();
  // As many as may be at once: every batch reads all weights. An actor's scores do not depend on who is with it.
  const int together = std::min(model_.engine->inference_unit(), (n + parallel_.threads() - 1) / parallel_.threads());
  parallel_.run(shard_count(n, together), [&](int shard, int thread) {
    const Range range = shard_range(n, together, shard);
    const std::span<const int> part(actors.data() + range.begin, size_t(range.size()));
    uint8_t* seen = observations + range.begin * world_.observation_size();
    actors_.episodes().observe(part, model_.window, seen);
    std::vector<int> pair, env, task;
    for (const int actor : part) {
      pair.push_back(actors_.pair_number(actor));
      env.push_back(actors_.episodes()[actor].pair.env);
      task.push_back(actors_.episodes()[actor].pair.task);
    }
    float* features = psi + size_t(range.begin) * d;
    model_.engine->infer(thread, range.size(), seen, pair.data(), logits + size_t(range.begin) * actions, features);
    value_->infer(range.size(), features, env.data(), task.data(), model_.parameters.data(), values + range.begin);
  });
}

void Ppo::collect() {
  const int count = actors_.count(), d = model_.shape.feature;
  Rollout& r = rollout_;
  r.observations.resize(size() * world_.observation_size());
  for (std::vector<int>* values : {&r.env, &r.task, &r.action}) values->resize(size());
  for (std::vector<float>* values : {&r.log_probability, &r.reward, &r.value, &r.cut_value}) values->assign(size(), 0);
  r.last_value.resize(count);
  r.end.assign(size(), StepEnd::kGoesOn);
  std::vector<std::pair<int, int>> pairs;
  for (const EnvTask& pair : actors_.pairs()) pairs.emplace_back(pair.env, pair.task);
  model_.engine->prepare_inference(parallel_, model_.parameters.data(), model_.statistics.data(), pairs);
  value_->prepare_inference(value_parameters_.data());

  const int actions = world_.actions();
  std::vector<double> p(actions);
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  std::vector<float> logits(size_t(count) * actions), psi(size_t(count) * d);
  std::vector<uint8_t> spare(count * world_.observation_size());
  for (int t = 0; t < options_.rollout; ++t) {
    const size_t first = size_t(t) * count;
    look(all, r.observations.data() + first * world_.observation_size(), logits.data(), psi.data(),
         r.value.data() + first);
    std::vector<int> cut;
    for (int actor = 0; actor < count; ++actor) {
      const size_t at = first + actor;
      const EnvTask pair = actors_.episodes()[actor].pair;
      const float* scores = logits.data() + size_t(actor) * actions;
      const double log_sum = softmax(scores, actions, 1, p.data());
      const int action =
          draw(p.data(), actions,
               Random(seed_, Purpose::kActorMove, uint64_t(actor), uint64_t(steps_ / count + t)).uniform());
      r.env[at] = pair.env;
      r.task[at] = pair.task;
      r.action[at] = action;
      r.log_probability[at] = float(scores[action] - log_sum);
      const WorldStep step = actors_.step(actor, action);
      r.reward[at] = float(step.reward_cents) / 100;
      if (step.terminated) actors_.restart(actor);
      if (step.truncated) cut.push_back(actor);
      r.end[at] = step.terminated ? StepEnd::kTerminated : step.truncated ? StepEnd::kTruncated : StepEnd::kGoesOn;
    }
    if (cut.empty()) continue;
    std::vector<float> cut_values(cut.size());
    look(cut, spare.data(), logits.data(), psi.data(), cut_values.data());
    for (size_t i = 0; i < cut.size(); ++i) {
      r.cut_value[first + cut[i]] = cut_values[i];
      actors_.restart(cut[i]);
    }
  }
  look(all, spare.data(), logits.data(), psi.data(), r.last_value.data());
  steps_ += size();

  r.advantage = advantages(
      {options_.rollout, count, r.reward.data(), r.value.data(), r.end.data(), r.cut_value.data(), r.last_value.data()},
      options_.gae);
  r.target.resize(size());
  double sum = 0, squares = 0, target_sum = 0, target_squares = 0;
  for (int i = 0; i < size(); ++i) {
    r.target[i] = r.advantage[i] + r.value[i];
    sum += r.advantage[i];
    squares += double(r.advantage[i]) * r.advantage[i];
    target_sum += r.target[i];
    target_squares += double(r.target[i]) * r.target[i];
  }
  const double mean = sum / size(), variance = squares / size() - mean * mean;
  const double target_variance = target_squares / size() - target_sum / size() * target_sum / size();
  // The advantage is what the value has not explained of the return.
  report_.explained_variance += target_variance > 0 ? 1 - variance / target_variance : 0;
  for (float& advantage : r.advantage)
    advantage = float((advantage - mean) / (std::sqrt(std::max(0.0, variance)) + 1e-8));
}

PpoLosses Ppo::learn_minibatch(const std::vector<int>& rows, bool value_alone) {
  const std::vector<uint8_t> observations = gathered(rollout_.observations, rows, world_.observation_size());
  const std::vector<int> env = gathered(rollout_.env, rows), task = gathered(rollout_.task, rows),
                         action = gathered(rollout_.action, rows);
  const std::vector<float> reward = gathered(rollout_.reward, rows),
                           log_probability = gathered(rollout_.log_probability, rows),
                           advantage = gathered(rollout_.advantage, rows), target = gathered(rollout_.target, rows);
  const PpoBatch batch = {.steps = {.size = int(rows.size()),
                                    .observations = observations.data(),
                                    .env = env.data(),
                                    .task = task.data(),
                                    .label = action.data(),
                                    .taken = action.data(),
                                    .reward = reward.data()},
                          .actions = world_.actions(),
                          .log_probability = log_probability.data(),
                          .advantage = advantage.data(),
                          .target = target.data()};
  PpoUpdate update = {options_.losses,        options_.clipping,  options_.value_loss,
                      options_.gradient_norm, options_.optimiser, options_.optimiser};
  // While the value alone learns, the policy's mean squares are gathered, but it does not move: they start at zero, and
  // the first steps would be ten times as long as those that follow.
  if (value_alone) update.policy.learning_rate = 0;
  const PpoLosses losses = model_.engine->update_ppo(parallel_, batch, update);
  check_finite(losses.total, updates_ + 1);
  return losses;
}

void Ppo::update() {
  collect();
  model_.engine->take_ppo(*value_, {model_.parameters.data(), model_.statistics.data(), v_.data(),
                                    value_parameters_.data(), value_v_.data()});
  const bool value_alone = updates_ < options_.value_warm_up;
  std::vector<int> order(size());
  for (int epoch = 0; epoch < options_.epochs; ++epoch) {
    std::iota(order.begin(), order.end(), 0);
    Random random(seed_, Purpose::kRolloutOrder, uint64_t(epoch), uint64_t(updates_));
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(uint32_t(i))]);
    const int rows = size() / options_.minibatches;
    for (int m = 0; m < options_.minibatches; ++m) {
      const PpoLosses losses = learn_minibatch({order.begin() + m * rows, order.begin() + (m + 1) * rows}, value_alone);
      if (epoch == 0 && m == 0) first_ = losses;
      report_.policy += losses.policy;
      report_.value += losses.value;
      report_.entropy += losses.entropy;
      report_.kl += losses.kl;
      report_.clip_fraction += losses.clip_fraction;
      ++reported_minibatches_;
    }
  }
  model_.engine->give_back();
  ++updates_;
  ++reported_rollouts_;
  model_.states += size();
  ++model_.updates;
}

PpoReport Ppo::take_report() {
  PpoReport report = std::exchange(report_, {});
  report.updates = updates_;
  report.steps = steps_;
  report.finished = actors_.take_finished();
  report.explained_variance /= std::max(1, reported_rollouts_);
  for (double* mean : {&report.policy, &report.value, &report.entropy, &report.kl, &report.clip_fraction})
    *mean /= std::max(1, reported_minibatches_);
  reported_minibatches_ = reported_rollouts_ = 0;
  return report;
}

Checkpoint Ppo::checkpoint(bool with_training_state) const {
  Checkpoint c = describe_model(model_, world_);
  for (const auto& [name, value] : options_.describe()) c.options[name] = value;
  add_tensors(c.file, "", model_.policy->parameters(), model_.parameters.data());
  add_tensors(c.file, "", model_.policy->statistics(), model_.statistics.data());
  if (!with_training_state) return c;
  add_tensors(c.file, "train/ppo/v/", model_.policy->parameters(), v_.data());
  add_tensors(c.file, "train/ppo/", value_->parameters(), value_parameters_.data());
  add_tensors(c.file, "train/ppo/value/v/", value_->parameters(), value_v_.data());
  actors_.save(c.file, "train/ppo/lanes/");
  const int64_t position[3] = {updates_, steps_, int64_t(seed_)};
  c.file.add("train/ppo/position", {3}, position, 3);
  return c;
}

void Ppo::resume(const Checkpoint& checkpoint) {
  const SafeTensors& file = checkpoint.file;
  if (!file.has("train/ppo/position"))
    fail(Exit::kData, "the checkpoint is not one of synpo-finetune ppo, or was stripped");
  options_.check_same(checkpoint);
  const uint64_t seed = naming_file(checkpoint, [&] { return load_training_state(file); });
  if (seed != seed_) fail(Exit::kData, "the run in the checkpoint has seed ", seed, ", not ", seed_);
}

uint64_t Ppo::load_training_state(const SafeTensors& file) {
  get_tensors(file, "train/ppo/v/", model_.policy->parameters(), v_.data());
  get_tensors(file, "train/ppo/", value_->parameters(), value_parameters_.data());
  get_tensors(file, "train/ppo/value/v/", value_->parameters(), value_v_.data());
  actors_.load(file, "train/ppo/lanes/");
  int64_t position[3];
  file.get("train/ppo/position", position, 3);
  constexpr int64_t kMost = int64_t(1) << 53;
  if (position[0] < 0 || position[1] < 0 || position[0] > kMost || position[1] > kMost)
    fail(Exit::kData, "tensor 'train/ppo/position' is malformed");
  updates_ = position[0];
  steps_ = position[1];
  return uint64_t(position[2]);
}

}  // namespace synpo
