// The losses of PPO (Schulman et al. 2017) over a minibatch of n steps, and their gradients.
//
//   objective_t = min(ratio A, clip(ratio, 1 - c, 1 + c) A),  ratio = pi(a|s) / pi_old(a|s)
//   loss = -mean objective - entropy weight * mean entropy
#pragma once

namespace synpo {

// The n steps of a rollout: the action taken, log pi_old of it, and its advantage.
struct ActedSteps {
  int n;
  const int* action;
  const float* log_probability;
  const float* advantage;
};

struct ClippingOptions {
  double clip = 0.1, entropy = 0.01;
};

// Means over the steps, `policy` being -objective, and the extremes of the ratio. kl is an estimate of KL(pi_old, pi):
// ratio - 1 - log ratio.
struct ClippedLosses {
  double policy = 0, entropy = 0, kl = 0, clip_fraction = 0, largest_ratio = 1, smallest_ratio = 1;
};

// dlogits [n, actions] = the loss's gradient.
ClippedLosses clipped_objective(const ActedSteps& steps, const ClippingOptions& options, int actions,
                                const float* logits, float* dlogits);

// 1/2 mean (value - target)^2, both [n]; dvalue = its gradient.
double value_loss(int n, const float* value, const float* target, float* dvalue);

}  // namespace synpo
