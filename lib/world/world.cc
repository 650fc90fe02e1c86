#include "world/world.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {

// More than any plan has: a planner that goes on so long goes in circles.
constexpr int kMostPlanned = 100 * kStepLimit;

}  // namespace

void StateHistory::push(const WorldState& state) {
  std::copy(states.begin() + 1, states.end(), states.begin());
  states.back() = state;
  count = uint8_t(std::min(count + 1, kHistory));
}

World::World(WorldFacts facts) : facts_(std::move(facts)) {
  std::vector<Environment> given;
  given.swap(facts_.environments);
  for (Environment& env : given) add_environment(std::move(env));
}

void World::add_environment(Environment environment) {
  if (!env_numbers_.emplace(environment.name, envs()).second)
    fail(Exit::kData, "two environments are named ", quoted(environment.name));
  facts_.environments.push_back(std::move(environment));
}

void World::action_values(EnvTask pair, const WorldState& state, int* cents) const {
  for (int first = 0; first < actions(); ++first) {
    WorldState now = state;
    now.steps = 0;
    WorldStep taken = step(pair, now, first);
    cents[first] = taken.reward_cents;
    for (int steps = 1; !taken.terminated; ++steps) {
      if (steps == kMostPlanned)
        fail(Exit::kInternal, "world ", quoted(name()), ": the expert's episode has no end within ", kMostPlanned,
             " steps");
      now.steps = 0;
      taken = step(pair, now, expert(pair, now));
      cents[first] += taken.reward_cents;
    }
  }
}

bool World::at_choice(EnvTask pair, const WorldState& state) const {
  for (int action = moves(); action < actions(); ++action) {
    WorldState now = state;
    now.steps = 0;
    if (step(pair, now, action).terminated || now.bytes != state.bytes) return true;
  }
  return false;
}

std::vector<std::string> World::env_names() const {
  std::vector<std::string> names;
  for (const Environment& env : environments()) names.push_back(env.name);
  return names;
}

int World::env_index(const std::string& name) const {
  const auto found = env_numbers_.find(name);
  return found == env_numbers_.end() ? -1 : found->second;
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
