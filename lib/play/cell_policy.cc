#include "play/cell_policy.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "nn/softmax.h"

namespace synpo {
namespace {

// The policy's choice, as it acts by itself: by chance, or, where scores are values, the best action.
ActionRates rates_of(const float* scores, int actions, bool values) {
  ActionRates rates(size_t(actions), 0);
  if (!values) {
    softmax(scores, actions, 1, rates.data());
    return rates;
  }
  const float top = *std::max_element(scores, scores + actions);
  const auto best = std::count(scores, scores + actions, top);
  for (int a = 0; a < actions; ++a) rates[size_t(a)] = scores[a] == top ? 1.0 / double(best) : 0;
  return rates;
}

}  // namespace

std::vector<ActionRates> probe_states(Policy<float>& policy, const World& world, EnvTask pair,
                                      const std::vector<WorldState>& states, int window, int remembered) {
  constexpr size_t kMost = Policy<float>::kInferenceUnit;
  const size_t observation = world.observation_size(), actions = size_t(world.actions());
  std::vector<uint8_t> observations(kMost * observation);
  std::vector<float> scores(kMost * actions);
  const std::vector<int> pair_of(kMost, 0);
  std::vector<ActionRates> rates;
  for (size_t first = 0; first < states.size(); first += kMost) {
    const size_t size = std::min(kMost, states.size() - first);
    for (size_t i = 0; i < size; ++i) {
      StateHistory history;
      for (int k = 0; k < remembered; ++k) history.push(states[first + i]);
      world.observe(pair.env, history, window, observations.data() + i * observation);
    }
    policy.infer(0, int(size), observations.data(), pair_of.data(), scores.data());
    for (size_t i = 0; i < size; ++i)
      rates.push_back(rates_of(scores.data() + i * actions, int(actions), policy.temperature() == 0));
  }
  return rates;
}

}  // namespace synpo
