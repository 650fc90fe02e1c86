// An episode that the planner plays in a world that a reader has made.
#pragma once
#include "base/random.h"
#include "fuzz.h"
#include "world/world.h"

namespace synpo::fuzz {

// Of a task drawn in the first environment, from a start drawn there; which is returned.
inline WorldState play(const World& world) {
  Random random(1, Purpose::kEpisodeStart);
  const EnvTask pair = {0, int(random.below(uint32_t(world.task_count())))};
  const WorldState start = world.reset(0, random);
  require(world.start_state(0, world.start_places(0, start)) == start, "a start has places");
  WorldState state = start;
  bool ended = false;
  for (int step = 0; step < kStepLimit && !ended; ++step) {
    require(world.valid(pair, state), "a state of an episode is valid");
    const WorldStep result = world.step(pair, state, world.expert(pair, state));
    require(!result.wrong, "the planner does nothing wrong");
    ended = result.ended();
  }
  require(ended, "an episode ends");
  return start;
}

}  // namespace synpo::fuzz
