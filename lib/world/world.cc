#include "world/world.h"

#include <algorithm>

namespace synpo {

void StateHistory::push(const WorldState& state) {
  std::copy(states.begin() + 1, states.end(), states.begin());
  states.back() = state;
  count = uint8_t(std::min(count + 1, kHistory));
}

int World::env_index(const std::string& name) const {
  const auto& all = environments();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Environment& env) { return env.name == name; });
  return found == all.end() ? -1 : int(found - all.begin());
}

int World::task_index(const std::string& name) const {
  const auto& all = task_names();
  const auto found = std::find(all.begin(), all.end(), name);
  return found == all.end() ? -1 : int(found - all.begin());
}

StepKind World::kind(EnvTask pair, const WorldState& state, int label) const {
  if (state.steps == 0) return StepKind::kStart;
  if (label >= moves()) return StepKind::kPick;
  return at_choice(pair, state) ? StepKind::kWalkOn : StepKind::kMove;
}

}  // namespace synpo
