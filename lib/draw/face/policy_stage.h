// A policy against the expert, with the agent in every place of an environment.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "world/world.h"

namespace synpo {

// The best action of a policy in a state.
struct PolicyChoice {
  int action;  // of the highest probability, the first of them
  double probability;
  std::vector<bool> optimal;  // by action; several where ways are equally short
  bool agrees() const { return optimal[size_t(action)]; }
};

// A panel: a stage of the task.
struct PolicyStage {
  std::vector<WorldState> states;  // all alike but for the agent's place
  int remembered;                  // how many times the state a policy should remember that knows stages like this one
  std::vector<PolicyChoice> choices;  // in the states
  int agreeing() const;
};

// `rates` are the probabilities of the actions in each state.
std::vector<PolicyChoice> compare_to_expert(const World& world, EnvTask pair, const std::vector<WorldState>& states,
                                            const std::vector<std::vector<double>>& rates);

struct PolicyPictureStyle {
  std::string title, caption;
  double scale = 2;  // pixels per point
};

}  // namespace synpo
