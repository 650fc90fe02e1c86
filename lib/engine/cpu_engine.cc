#include "engine/cpu_engine.h"

#include <cmath>

namespace synpo {

Losses CpuEngine::update(Parallel& parallel, const StepBatch<float>& batch, const StepOptions& options,
                         const AdamUpdate& adam, float* logits) {
  const size_t count = policy_.parameters().total(), statistics = policy_.statistics().total();
  if (gradient_.size() < count) {
    gradient_.grow(count);
    gradient_.zero();  // what lies between tensors stays so
  }
  const Losses losses =
      policy_.step(parallel, batch, options, arrays_.parameters, arrays_.statistics, gradient_.data(), logits);
  if (!std::isfinite(losses.total)) return losses;
  adam_step(parallel, adam.options, adam.step, count, gradient_.data(), arrays_.parameters, arrays_.first_moment,
            arrays_.second_moment, arrays_.average, adam.keep);
  if (arrays_.average_statistics)
    for (size_t i = 0; i < statistics; ++i)
      arrays_.average_statistics[i] =
          float(adam.keep * arrays_.average_statistics[i] + (1 - adam.keep) * arrays_.statistics[i]);
  return losses;
}

}  // namespace synpo
