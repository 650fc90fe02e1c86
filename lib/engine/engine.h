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
#include "policy/policy.h"

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
  // step(), then Adam. Where the total loss is not finite, nothing but the running statistics has changed, or the
  // training is over: give_back() then has nothing good to give.
  virtual Losses update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                        const AdamUpdate& adam, float* logits) = 0;
  virtual void give_back() = 0;
};

}  // namespace synpo
