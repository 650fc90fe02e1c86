// The engine that is always there: a policy's own step, and Adam.
#pragma once
#include <utility>
#include <vector>

#include "engine/engine.h"
#include "nn/buffer.h"

namespace synpo {

class CpuEngine : public Engine {
 public:
  // The policy must live as long.
  explicit CpuEngine(Policy<float>& policy) : policy_(policy) {}

  Losses step(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options, const float* parameters,
              float* statistics, float* gradient, float* logits) override {
    return policy_.step(parallel, batch, options, parameters, statistics, gradient, logits);
  }
  void prepare_inference(Parallel& parallel, const float* parameters, const float* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override {
    policy_.prepare_inference(parallel, parameters, statistics, pairs);
  }
  void infer(int thread, int size, const uint8_t* observations, const int* pair, float* logits, float* psi) override {
    policy_.infer(thread, size, observations, pair, logits, psi);
  }
  int inference_unit() const override { return Policy<float>::kInferenceUnit; }

  void take(const TrainingArrays& arrays) override { arrays_ = arrays; }
  void begin_update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                    const AdamUpdate& adam, float* logits) override;
  Losses end_update() override { return losses_; }
  void give_back() override {}
  void take_ppo(ValueFunction& value, const PpoArrays& arrays) override {
    value_ = &value;
    ppo_ = arrays;
  }
  PpoLosses update_ppo(Parallel& parallel, const PpoBatch& batch, const PpoUpdate& update) override;

 private:
  class PpoObjective;
  void make_gradient();

  Policy<float>& policy_;
  TrainingArrays arrays_ = {};
  ValueFunction* value_ = nullptr;
  PpoArrays ppo_ = {};
  Buffer<float> gradient_;
  Losses losses_;  // of the last update
};

}  // namespace synpo
