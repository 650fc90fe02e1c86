#include "learn/imitate.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error.h"
#include "format/safetensors.h"
#include "learn/finite.h"
#include "nn/layout.h"
#include "nn/loss.h"
#include "play/episode.h"
#include "play/evaluate.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {
namespace {

// The window is not known before the first trajectory.
Model start_model(const World& world, const std::string& method, const ImitationOptions& options,
                  std::vector<EnvTask> seen, uint64_t seed) {
  Model model = fresh_model(method, options.shape(world), {seed, options.embedding_sd});
  model.window = -1;
  model.seen = std::move(seen);
  return model;
}

// The model of a checkpoint that a run can go on from. Nothing is made as large as its options say before its tensors
// have been seen.
Model resumable(const World& world, const Checkpoint& checkpoint) {
  if (!checkpoint.file.has("train/position"))
    fail(Exit::kData, kNoTrainingState, "the checkpoint has no training state (was it stripped?)");
  Model saved = load_model(checkpoint, world);
  if (describe_shape(saved.shape) != describe_shape(parse_options(checkpoint.options).shape(world)))
    fail(Exit::kData, "the checkpoint's shape and options disagree");
  return saved;
}

void copy(const Buffer<float>& from, Buffer<float>& to) {
  to.grow(from.size());
  std::copy_n(from.data(), from.size(), to.data());
}

}  // namespace

Imitation::Imitation(const World& world, Parallel& parallel, const std::string& method, const ImitationOptions& options,
                     std::vector<EnvTask> seen, uint64_t seed)
    : world_(world), parallel_(parallel), options_(options),
      model_(start_model(world, method, options, std::move(seen), seed)), memory_(size_t(options.memory)),
      running_(world, options.running_options(0, 0), seed), seen_grows_(model_.seen.empty()) {
  const size_t count = model_.parameters.size();
  first_moment_.grow(count);
  second_moment_.grow(count);
  first_moment_.zero();
  second_moment_.zero();
  copy(model_.parameters, average_);
  copy(model_.statistics, average_statistics_);
}

Imitation::Imitation(const World& world, Parallel& parallel, const Checkpoint& checkpoint)
    : Imitation(world, parallel, checkpoint, resumable(world, checkpoint)) {}

Imitation::Imitation(const World& world, Parallel& parallel, const Checkpoint& checkpoint, const Model& saved)
    : Imitation(world, parallel, checkpoint.method, parse_options(checkpoint.options), {}, checkpoint.seed) {
  model_.seen = saved.seen;
  model_.updates = saved.updates;
  model_.states = saved.states;
  model_.window = saved.window;
  copy(saved.parameters, average_);
  copy(saved.statistics, average_statistics_);
  naming_file(checkpoint, [&] { load_training_state(checkpoint.file); });
}

void Imitation::load_training_state(const SafeTensors& file) {
  const Layout& parameters = model_.policy->parameters();
  const Layout& statistics = model_.policy->statistics();
  const bool averaged = options_.averaging > 0;
  get_tensors(file, averaged ? "train/raw/" : "", parameters, model_.parameters.data());
  get_tensors(file, averaged ? "train/raw/" : "", statistics, model_.statistics.data());
  get_tensors(file, "train/m/", parameters, first_moment_.data());
  get_tensors(file, "train/v/", parameters, second_moment_.data());
  const std::vector<uint64_t> position = file.get_bits("train/position");
  if (position.size() != 4)
    fail(Exit::kData, "tensor 'train/position': found ", position.size(), " values, expected 4");
  stream_lines_ = position[0];
  stream_hash_ = position[1];
  total_updates_ = int64_t(std::min<uint64_t>(position[2], INT64_MAX));
  seen_grows_ = position[3] != 0;
  memory_.load(file, "train/memory/", world_);
  if (options_.batch_states > 0) running_.load(file, "train/running/", memory_);
}

void Imitation::take_weights(const Model& other) {
  if (other.method != model_.method || describe_shape(other.shape) != describe_shape(model_.shape))
    fail(Exit::kData, "the checkpoint's network is not the one asked for: method or sizes differ");
  for (auto* to : {&model_.parameters, &average_})
    std::copy_n(other.parameters.data(), other.parameters.size(), to->data());
  for (auto* to : {&model_.statistics, &average_statistics_})
    std::copy_n(other.statistics.data(), other.statistics.size(), to->data());
}

void Imitation::read(TrajectoryStream& stream) {
  const int64_t wanted = int64_t(model_.updates == 0 ? std::max(options_.fill, options_.read) : options_.read);
  // All or none of them: a signal may come while the stream is read.
  std::vector<Episode> episodes;
  while (int64_t(episodes.size()) < wanted) {
    std::optional<Episode> episode = stream.next();
    if (!episode) break;
    episodes.push_back(std::move(*episode));
  }
  for (Episode& episode : episodes) {
    if (seen_grows_ && !model_.is_seen(episode.pair)) model_.seen.push_back(episode.pair);
    memory_.add(std::move(episode));
  }
  stream_lines_ = stream.lines();
  stream_hash_ = stream.hash();
  if (model_.window < 0) model_.window = stream.window();
}

void Imitation::compute_on(const DeviceOptions& device) {
  synpo::compute_on(device, parallel_, model_);
  engine_has_all_ = false;
}

void Imitation::compute_with(const std::function<std::unique_ptr<Engine>(Policy<float>&)>& make) {
  model_.engine = make(*model_.policy);
  engine_has_all_ = false;
}

void Imitation::give_to_engine() {
  const bool averaged = options_.averaging > 0;
  model_.engine->take({model_.parameters.data(), model_.statistics.data(), first_moment_.data(), second_moment_.data(),
                       averaged ? average_.data() : nullptr, averaged ? average_statistics_.data() : nullptr});
  engine_has_all_ = true;
}

void Imitation::draw(const RunningOptions& running) {
  batch_.needs = model_.policy->needs();
  if (options_.batch_states > 0) {
    running_.set_options(running);
    running_.draw(memory_, parallel_, int(options_.batch_states), model_.window, model_.updates, batch_);
  } else {
    TrajectoryDraw::draw(world_, memory_, parallel_, int(options_.trajectories), model_.window, model_.seed,
                         model_.updates, batch_);
  }
}

bool Imitation::learn() {
  if (memory_.size() == 0) return false;
  const bool single_steps = options_.batch_states > 0;
  const RunningOptions running = options_.running_options(model_.updates, total_updates_);
  draw(running);
  settle();  // the update before, which the engine may have computed meanwhile

  std::swap(batch_, learning_);
  const int n = learning_.size();
  logits_.grow(size_t(n) * world_.actions());
  const StepBatch<float> steps = {.size = n,
                                  .observations = learning_.observations.data(),
                                  .env = learning_.env.data(),
                                  .task = learning_.task.data(),
                                  .label = learning_.label.data(),
                                  .taken = learning_.taken.data(),
                                  .reward = learning_.reward.data(),
                                  .seed = model_.seed,
                                  .update = uint64_t(model_.updates),
                                  .next = learning_.next.data(),
                                  .planner_q = learning_.planner_q.data()};
  // The first updates' weights are far from where the average should be.
  AdamUpdate adam = {options_.adam(), model_.updates + 1,
                     std::min(options_.averaging, (1.0 + model_.updates) / (10.0 + model_.updates))};
  adam.options.learning_rate = options_.rate(model_.updates, total_updates_);
  if (!engine_has_all_) give_to_engine();
  model_.engine->begin_update(parallel_, steps, options_.step(), adam, logits_.data());
  unsettled_ = true;
  ++model_.updates;
  model_.states += n;
  // Running episodes go on before anything is read: by the learner's own moves, or without them.
  const bool own_moves = single_steps && running.roll_in > 0;
  if (own_moves) settle();
  if (single_steps) running_.advance(memory_, greedy_, model_.updates - 1);
  return true;
}

void Imitation::settle() {
  if (!std::exchange(unsettled_, false)) return;
  const Losses losses = model_.engine->end_update();
  check_finite(losses.total, model_.updates);
  const int n = learning_.size(), actions = world_.actions();
  greedy_.resize(n);
  for (int i = 0; i < n; ++i) {
    greedy_[i] = argmax(logits_.data() + size_t(i) * actions, actions);
    const int kind = int(learning_.kind[i]);
    ++kind_count_[kind];
    kind_right_[kind] += greedy_[i] == learning_.label[i];
  }
  ++reported_updates_;
  reported_states_ += n;
  loss_sum_.total += losses.total;
  loss_sum_.policy += losses.policy;
  loss_sum_.reward += losses.reward;
  loss_sum_.env += losses.env;
  loss_sum_.task += losses.task;
}

RunLogRow Imitation::take_report() {
  settle();
  RunLogRow row;
  row.update = model_.updates;
  row.states = model_.states;
  row.trajectories = int64_t(stream_lines_);
  row.learning_rate = options_.rate(std::max<int64_t>(0, model_.updates - 1), total_updates_);
  const double updates = double(std::max<int64_t>(1, reported_updates_));
  row.loss = loss_sum_.total / updates;
  row.policy = loss_sum_.policy / updates;
  row.reward = loss_sum_.reward / updates;
  row.env = loss_sum_.env / updates;
  row.task = loss_sum_.task / updates;
  row.states_per_s = double(reported_states_);
  for (int k = 0; k < kStepKinds; ++k) {
    row.right[k] = double(kind_right_[k]) / kind_count_[k];
    kind_right_[k] = kind_count_[k] = 0;
  }
  reported_updates_ = reported_states_ = 0;
  loss_sum_ = {};
  return row;
}

RunLogRow::Evaluation Imitation::evaluate_sample(int episodes) {
  settle();
  model_.engine->give_back();
  return synpo::evaluate_sample(parallel_, world_, model_, best_parameters().data(), best_statistics().data(),
                                episodes);
}

Checkpoint Imitation::checkpoint(bool with_training_state) {
  settle();
  model_.engine->give_back();
  Checkpoint c = describe_model(model_, world_);
  c.options = describe_options(options_);
  const Layout& parameters = model_.policy->parameters();
  const Layout& statistics = model_.policy->statistics();
  add_tensors(c.file, "", parameters, best_parameters().data());
  add_tensors(c.file, "", statistics, best_statistics().data());
  if (!with_training_state) return c;
  if (options_.averaging > 0) {
    add_tensors(c.file, "train/raw/", parameters, model_.parameters.data());
    add_tensors(c.file, "train/raw/", statistics, model_.statistics.data());
  }
  add_tensors(c.file, "train/m/", parameters, first_moment_.data());
  add_tensors(c.file, "train/v/", parameters, second_moment_.data());
  c.file.add_bits("train/position", {stream_lines_, stream_hash_, uint64_t(total_updates_), seen_grows_});
  memory_.save(c.file, "train/memory/", world_);
  if (options_.batch_states > 0) running_.save(c.file, "train/running/");
  return c;
}

}  // namespace synpo
