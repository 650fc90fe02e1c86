// PPO fine-tuning (supplement, Section 3; Schulman et al. 2017): worlds under the learner's own actions, advantages by
// GAE, the clipped objective.
//
//   loss = the clipped objective's and the value's (clipped_objective.h) + the auxiliary losses of imitation, at the
//   action taken
//
// Advantages are normalised over the rollout. Batch normalisation keeps the statistics that it came with, so that the
// first minibatch after a rollout has ratio 1.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "engine/engine.h"
#include "format/checkpoint.h"
#include "learn/ppo/gae.h"
#include "learn/ppo/ppo_options.h"
#include "nn/buffer.h"
#include "play/actors.h"
#include "play/model.h"
#include "play/running_episode.h"
#include "policy/value_function.h"
#include "world/world.h"

namespace synpo {

// Means since the report before.
struct PpoReport {
  int64_t updates = 0, steps = 0;
  Outcomes finished;
  double policy = 0, value = 0, entropy = 0, kl = 0, clip_fraction = 0, explained_variance = 0;
};

class Ppo {
 public:
  // Fine-tunes `model` on its seen pairs. Throws kUsage for sizes that do not divide.
  Ppo(const World& world, Parallel& parallel, Model model, const PpoOptions& options, uint64_t seed);
  // Takes up a run where checkpoint() left it. Throws kData for a checkpoint of anything else.
  void resume(const Checkpoint& checkpoint);

  // From scratch: running statistics of normalisation from random play.
  void measure_statistics(int batches);

  // One rollout and what is learned from it.
  void update();

  const Model& model() const { return model_; }
  int64_t steps() const { return steps_; }
  int64_t updates() const { return updates_; }
  PpoReport take_report();
  Checkpoint checkpoint(bool with_training_state) const;

  // Of the first minibatch after the last rollout.
  const PpoLosses& first_minibatch() const { return first_; }

 private:
  uint64_t load_training_state(const SafeTensors& file);  // returns the run's seed
  struct Rollout {
    std::vector<uint8_t> observations;
    std::vector<int> env, task, action;
    std::vector<float> log_probability, reward, value, cut_value, last_value, advantage, target;
    std::vector<StepEnd> end;
  };
  int size() const { return options_.lanes * options_.rollout; }
  // Scores, psi and values where these actors stand.
  void look(const std::vector<int>& actors, uint8_t* observations, float* logits, float* psi, float* values);
  void collect();
  PpoLosses learn_minibatch(const std::vector<int>& rows, bool value_alone);

  const World& world_;
  Parallel& parallel_;
  PpoOptions options_;
  uint64_t seed_;
  Model model_;
  std::unique_ptr<ValueFunction> value_;
  std::vector<float> value_parameters_, value_v_;
  Buffer<float> v_;
  Actors actors_;
  Rollout rollout_;
  int64_t updates_ = 0, steps_ = 0;
  PpoLosses first_;
  PpoReport report_;
  int reported_minibatches_ = 0, reported_rollouts_ = 0;
};

}  // namespace synpo
