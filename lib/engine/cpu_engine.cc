#include "engine/cpu_engine.h"

#include <cmath>
#include <vector>

namespace synpo {

void CpuEngine::make_gradient() {
  const size_t count = policy_.parameters().total();
  if (gradient_.size() >= count) return;
  gradient_.grow(count);
  gradient_.zero();  // what lies between tensors stays so
}

void CpuEngine::begin_update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                             const AdamUpdate& adam, float* logits) {
  const size_t count = policy_.parameters().total(), statistics = policy_.statistics().total();
  make_gradient();
  losses_ = policy_.step(parallel, batch, options, arrays_.parameters, arrays_.statistics, gradient_.data(), logits);
  if (!std::isfinite(losses_.total)) return;
  adam_step(parallel, adam.options, adam.step, count, gradient_.data(), arrays_.parameters, arrays_.first_moment,
            arrays_.second_moment, arrays_.average, adam.keep);
  if (arrays_.average_statistics)
    for (size_t i = 0; i < statistics; ++i)
      arrays_.average_statistics[i] =
          float(adam.keep * arrays_.average_statistics[i] + (1 - adam.keep) * arrays_.statistics[i]);
}

// The loss of a minibatch's scores and values. The value function's gradient is kept here.
class CpuEngine::PpoObjective : public Objective<float> {
 public:
  PpoObjective(const CpuEngine& engine, const PpoBatch& batch, const PpoUpdate& update)
      : value_gradient(engine.value_->parameters().total()), value_(*engine.value_), arrays_(engine.ppo_),
        batch_(batch), update_(update) {}

  double apply(Parallel& parallel, int n, const float* psi, const float* logits, float* dlogits, float* dpsi) override {
    const StepBatch<float>& steps = batch_.steps;
    static_cast<ClippedLosses&>(losses) = clipped_objective({n, steps.taken, batch_.log_probability, batch_.advantage},
                                                            update_.clipping, batch_.actions, logits, dlogits);
    std::vector<float> dvalue(size_t(n), 0.0f);
    const float* value =
        value_.forward(parallel, n, psi, steps.env, steps.task, arrays_.parameters, arrays_.value_parameters);
    losses.value = value_loss(n, value, batch_.target, dvalue.data());
    // RMSProp would undo a weight in the value's own gradients: it is what psi hears of the value.
    value_.backward(parallel, float(update_.value_weight), dvalue.data(), arrays_.value_parameters,
                    value_gradient.data(), dpsi);
    return losses.policy + update_.value_weight * losses.value - update_.clipping.entropy * losses.entropy;
  }

  PpoLosses losses;
  std::vector<float> value_gradient;

 private:
  ValueFunction& value_;
  const PpoArrays& arrays_;
  const PpoBatch& batch_;
  const PpoUpdate& update_;
};

PpoLosses CpuEngine::update_ppo(Parallel& parallel, const PpoBatch& batch, const PpoUpdate& update) {
  make_gradient();
  PpoObjective objective(*this, batch, update);
  StepBatch<float> steps = batch.steps;
  steps.objective = &objective;
  steps.frozen_statistics = true;
  std::vector<float> logits(size_t(steps.size) * size_t(batch.actions));
  const Losses losses = policy_.step(parallel, steps, {update.auxiliary}, ppo_.parameters, ppo_.statistics,
                                     gradient_.data(), logits.data());
  objective.losses.total = losses.total;
  if (!std::isfinite(losses.total)) return objective.losses;
  std::vector<float>& value_gradient = objective.value_gradient;
  const size_t count = policy_.parameters().total(), value_count = value_gradient.size();
  const double length = std::sqrt(sum_of_squares(parallel, count, gradient_.data()) +
                                  sum_of_squares(parallel, value_count, value_gradient.data()));
  const float factor = float(clip_factor(length, update.gradient_norm));
  rmsprop_step(parallel, update.policy, count, factor, gradient_.data(), ppo_.parameters, ppo_.mean_squares);
  rmsprop_step(parallel, update.value, value_count, factor, value_gradient.data(), ppo_.value_parameters,
               ppo_.value_mean_squares);
  return objective.losses;
}

}  // namespace synpo
