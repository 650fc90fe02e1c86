// An episode that was played, with all its states, whatever its world.
#pragma once
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "world/world.h"

namespace synpo {

struct Film {
  const World& world;
  EnvTask pair;
  int window;                      // radius of what is seen, in worlds that have one
  std::vector<WorldState> states;  // before every action, and after the last
  std::vector<uint8_t> actions;
  std::vector<WorldStep> results;  // of every action
  int steps() const { return int(actions.size()); }
  bool terminated() const { return !results.empty() && results.back().terminated; }
};

// Plays the actions from the start. The world outlives the film, here and below.
Film play_film(const World& world, EnvTask pair, const WorldState& start, const std::vector<uint8_t>& actions,
               int window);

// The first `steps` steps of the expert's episode from the start that `random` draws. Throws kUsage when it is shorter.
Film expert_film(const World& world, EnvTask pair, Random random, int64_t steps, int window);

// Steps that the expert takes from here to success; -1 where it comes to none within an episode's limit.
int expert_steps(const World& world, EnvTask pair, WorldState state);

}  // namespace synpo
