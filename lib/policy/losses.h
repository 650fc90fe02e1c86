// The losses that policies learn from, and what each weighs.
#pragma once
#include <cmath>
#include <utility>

namespace synpo {

// The weights lambda of the auxiliary losses (supplement, Section 2).
struct LossWeights {
  double reward = 0.01, env = 0.1, task = 0.001;
};

// Means over the steps of a batch; NaN where the method has no such loss. `total` is weighted.
struct Losses {
  double total = 0, policy = 0, reward = 0, env = 0, task = 0;
  void add_up(const LossWeights& weights) {
    total = policy;
    for (const auto& [weight, loss] : {std::pair{weights.reward, reward}, {weights.env, env}, {weights.task, task}})
      if (!std::isnan(loss)) total += weight * loss;
  }
};

}  // namespace synpo
