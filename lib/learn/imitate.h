// Imitation learning (Algorithm 1): a stream of expert trajectories in, a trained model out.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "engine/device.h"
#include "engine/engine.h"
#include "format/checkpoint.h"
#include "format/run_log.h"
#include "learn/memory.h"
#include "learn/recipe.h"
#include "learn/steps.h"
#include "nn/buffer.h"
#include "play/model.h"
#include "play/stream.h"
#include "policy/losses.h"
#include "policy/policy.h"
#include "world/world.h"

namespace synpo {

constexpr Cause kNoTrainingState{"no training state"};

// Everything that a run needs to go on as if it had never stopped.
class Imitation {
 public:
  // A fresh run of `method`. No seen pairs: those that the stream brings.
  Imitation(const World& world, Parallel& parallel, const std::string& method, const ImitationOptions& options,
            std::vector<EnvTask> seen, uint64_t seed);
  // A run that goes on from a checkpoint with its train/ part. Throws kData where that is malformed or
  // missing (kNoTrainingState).
  Imitation(const World& world, Parallel& parallel, const Checkpoint& checkpoint);
  // Takes the weights of another model, whose shape must be this one's (kData).
  void take_weights(const Model& other);
  // Computes there from the first update on; without a call, on the CPU.
  void compute_on(const DeviceOptions& device);
  // The same with another engine, made for the policy.
  void compute_with(const std::function<std::unique_ptr<Engine>(Policy<float>&)>& make);

  // One update: reads, then draws and learns.
  bool update(TrajectoryStream& stream) {
    read(stream);
    return learn();
  }
  // What is due before the next update. Throws Stopped, and is as it was before, where a stop signal comes while the
  // stream is read.
  void read(TrajectoryStream& stream);
  // False when there is nothing to draw from: the stream ended before its first trajectory. Where what is drawn next
  // does not depend on it, the engine may still be computing afterwards.
  bool learn();
  // Waits for it. Called where results are asked for; also due before a time is taken.
  void settle();

  // The stream stood here; a resumed run skips to there.
  uint64_t stream_lines() const { return stream_lines_; }
  uint64_t stream_hash() const { return stream_hash_; }
  int64_t updates() const { return model_.updates; }
  int64_t total_updates() const { return total_updates_; }
  // The number of updates that the learning rate's schedule is laid out for.
  void set_total_updates(int64_t total) { total_updates_ = total; }
  const ImitationOptions& options() const { return options_; }
  int window() const { return model_.window; }
  const Model& model() const { return model_; }
  // The stream may bring these pairs; any where it is empty.
  std::vector<EnvTask> allowed() const { return seen_grows_ ? std::vector<EnvTask>() : model_.seen; }

  // Means since the last call: losses, accuracies, learning rate. Times are the caller's.
  RunLogRow take_report();
  // Success, at the policy's own temperature, on `episodes` seen and as many unseen pairs drawn at random, an episode
  // each; the same ones at every call. NaN where there are no such pairs.
  RunLogRow::Evaluation evaluate_sample(int episodes);

  Checkpoint checkpoint(bool with_training_state);

 private:
  Imitation(const World& world, Parallel& parallel, const Checkpoint& checkpoint, const Model& saved);
  void load_training_state(const SafeTensors& file);
  // Hands the arrays over to the engine.
  void give_to_engine();
  void draw(const RunningOptions& running);
  // These are evaluated and saved: the averaged weights where there are any.
  const Buffer<float>& best_parameters() const { return options_.averaging > 0 ? average_ : model_.parameters; }
  const Buffer<float>& best_statistics() const {
    return options_.averaging > 0 ? average_statistics_ : model_.statistics;
  }

  const World& world_;
  Parallel& parallel_;
  ImitationOptions options_;
  Model model_;
  ReplayMemory memory_;
  RunningDraw running_;
  Buffer<float> first_moment_, second_moment_, average_, average_statistics_, logits_;
  Minibatch batch_, learning_;  // drawn; given to the engine
  bool unsettled_ = false;      // the engine has results of the last update
  std::vector<int> greedy_;
  bool engine_has_all_ = false;  // parameters, statistics and moments
  int64_t total_updates_ = 0;
  uint64_t stream_lines_ = 0, stream_hash_ = Hash().value();
  bool seen_grows_;  // no seen pairs were given: those that the stream brings are

  // Sums since the last report.
  int64_t reported_updates_ = 0, reported_states_ = 0;
  Losses loss_sum_;
  int64_t kind_count_[kStepKinds] = {}, kind_right_[kStepKinds] = {};
};

}  // namespace synpo
