// Who computes: the network's losses, gradients and scores, and the updates of its parameters. Learning and evaluation
// ask an engine; which processor answers is the engine's own matter.
//
// CpuEngine (cpu_engine.h) is the policy of lib/policy itself. TorchEngine (torch_engine.h) does the same with
// LibTorch, on a GPU for instance.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/adam.h"
#include "nn/clipped_objective.h"
#include "nn/rmsprop.h"
#include "policy/losses.h"
#include "policy/policy.h"
#include "policy/value_function.h"

namespace synpo {

// What a training changes, laid out as the policy's parameters and statistics are. The averaged ones may be null.
struct TrainingArrays {
  float *parameters, *statistics;
  float *first_moment, *second_moment;
  float* average = nullptr;
  float* average_statistics = nullptr;
};

// How a gradient moves the parameters.
struct AdamUpdate {
  AdamOptions options;
  int64_t step = 1;  // counted from 1
  double keep = 0;   // of the averaged arrays: average = keep * average + (1 - keep) * value
};

// The same of PPO, whose policy and value function learn together; statistics stay. The value's arrays are laid out as
// its own parameters.
struct PpoArrays {
  float *parameters, *statistics, *mean_squares;
  float *value_parameters, *value_mean_squares;
};

// Steps of a rollout, whose actions are `taken` and `label` both, and what else PPO learns from, all [size]: log pi_old
// of the action, its advantage, and the value that the state should have.
struct PpoBatch {
  StepBatch<float> steps;
  int actions;
  const float *log_probability, *advantage, *target;
};

struct PpoUpdate {
  LossWeights auxiliary;
  ClippingOptions clipping;
  double value_weight = 1;     // of the value's loss, for psi and for the value function itself
  double gradient_norm = 0.5;  // the longest that the gradient of all parameters may be
  RmsPropOptions policy, value;
};

// Means over a minibatch.
struct PpoLosses : ClippedLosses {
  double value = 0;
  double total = 0;  // weighted, with the auxiliary losses
};

class Engine {
 public:
  virtual ~Engine() = default;

  // Forward and backward on a batch, as Policy::step() says; the arrays are the caller's.
  virtual Losses step(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                      const float* parameters, float* statistics, float* gradient, float* logits) = 0;

  // Scores of states, as Policy says of the same two; at most inference_unit() states at once.
  virtual void prepare_inference(Parallel& parallel, const float* parameters, const float* statistics,
                                 const std::vector<std::pair<int, int>>& pairs) = 0;
  virtual void infer(int thread, int size, const uint8_t* observations, const int* pair, float* logits,
                     float* psi = nullptr) = 0;
  virtual int inference_unit() const = 0;

  // A training of many updates: the engine takes the arrays, which must stay where they are, and may keep them where it
  // computes. After give_back() they hold what the updates have made of them.
  virtual void take(const TrainingArrays& arrays) = 0;
  // step(), then Adam, in two parts: between them an engine may still compute, and is asked for nothing else. The batch
  // may go after the first, which `logits` must not; losses and logits are there after the second. Where the total loss
  // is not finite, nothing but the running statistics has changed, or the training is over: give_back() then has
  // nothing good to give.
  virtual void begin_update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                            const AdamUpdate& adam, float* logits) = 0;
  virtual Losses end_update() = 0;
  Losses update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options, const AdamUpdate& adam,
                float* logits) {
    begin_update(parallel, batch, options, adam, logits);
    return end_update();
  }
  virtual void give_back() = 0;

  // The same of PPO, whose value function is always the same one.
  virtual void take_ppo(ValueFunction& value, const PpoArrays& arrays) = 0;
  // The gradient of the clipped objective, the value's loss and the auxiliary losses, then RMSProp for both networks.
  // Where the total loss is not finite, the same holds as above.
  virtual PpoLosses update_ppo(Parallel& parallel, const PpoBatch& batch, const PpoUpdate& update) = 0;
};

}  // namespace synpo
