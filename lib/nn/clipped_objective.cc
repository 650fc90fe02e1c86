#include "nn/clipped_objective.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "nn/softmax.h"

namespace synpo {

ClippedLosses clipped_objective(const ActedSteps& steps, const ClippingOptions& options, int actions,
                                const float* logits, float* dlogits) {
  const int n = steps.n;
  std::vector<double> p(actions), log_p(actions);
  ClippedLosses losses;
  for (int i = 0; i < n; ++i, logits += actions, dlogits += actions) {
    const int a = steps.action[i];
    const double log_sum = softmax(logits, actions, 1, p.data());
    double entropy = 0;
    for (int j = 0; j < actions; ++j) {
      log_p[j] = logits[j] - log_sum;
      entropy -= p[j] * log_p[j];
    }
    const double log_ratio = log_p[a] - steps.log_probability[i], ratio = std::exp(log_ratio),
                 advantage = steps.advantage[i];
    const double clipped = std::clamp(ratio, 1 - options.clip, 1 + options.clip);
    const bool limited = clipped * advantage < ratio * advantage;
    losses.policy -= (limited ? clipped : ratio) * advantage / n;
    losses.entropy += entropy / n;
    losses.kl += (ratio - 1 - log_ratio) / n;
    losses.clip_fraction += double(ratio != clipped) / n;
    losses.largest_ratio = std::max(losses.largest_ratio, ratio);
    losses.smallest_ratio = std::min(losses.smallest_ratio, ratio);
    for (int j = 0; j < actions; ++j) {
      const double along = limited ? 0 : -advantage * ratio * ((j == a) - p[j]);
      dlogits[j] = float((along + options.entropy * p[j] * (log_p[j] + entropy)) / n);
    }
  }
  return losses;
}

double value_loss(int n, const float* value, const float* target, float* dvalue) {
  double loss = 0;
  for (int i = 0; i < n; ++i) {
    const double error = value[i] - target[i];
    loss += 0.5 * error * error / n;
    dvalue[i] = float(error / n);
  }
  return loss;
}

}  // namespace synpo
