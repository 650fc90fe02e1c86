// A policy's choices in states that are asked about, such as wherever the agent might stand.
#pragma once
#include <vector>

#include "policy/policy.h"
#include "world/world.h"

namespace synpo {

// By action, in sum 1.
using ActionRates = std::vector<double>;

// In each of the states: softmax(scores) of the policy, or the best action where scores are values
// (Policy::temperature()). Its history is `remembered` times, 1 to kHistory, the state itself. The policy is prepared
// with `pair` as its pair number 0.
std::vector<ActionRates> probe_states(Policy<float>& policy, const World& world, EnvTask pair,
                                      const std::vector<WorldState>& states, int window, int remembered);

}  // namespace synpo
