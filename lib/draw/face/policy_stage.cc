#include "draw/face/policy_stage.h"

#include <algorithm>

namespace synpo {

int PolicyStage::agreeing() const {
  return int(std::count_if(choices.begin(), choices.end(), [](const PolicyChoice& choice) { return choice.agrees(); }));
}

std::vector<PolicyChoice> compare_to_expert(const World& world, EnvTask pair, const std::vector<WorldState>& states,
                                            const std::vector<std::vector<double>>& rates) {
  std::vector<PolicyChoice> choices;
  std::vector<int> values(size_t(world.actions()));
  for (size_t i = 0; i < states.size(); ++i) {
    const auto best = std::max_element(rates[i].begin(), rates[i].end());
    world.action_values(pair, states[i], values.data());
    const int top = *std::max_element(values.begin(), values.end());
    PolicyChoice choice{int(best - rates[i].begin()), *best, {}};
    for (const int value : values) choice.optimal.push_back(value == top);
    choices.push_back(choice);
  }
  return choices;
}

}  // namespace synpo
