// An episode under way: where it stands, what the agent remembers of it, and what it has brought so far.
#pragma once
#include <cstdint>

#include "world/world.h"

namespace synpo {

// Results of some episodes: sums over them.
struct Outcomes {
  int64_t episodes = 0, successes = 0, wrong = 0, timeouts = 0, reward_cents = 0, length = 0;
  void add(const Outcomes& other);
  bool operator==(const Outcomes&) const = default;
};

struct RunningEpisode {
  EnvTask pair = {0, 0};
  StateHistory history;      // the newest is where it stands; none before start()
  int64_t reward_cents = 0;  // of all steps

  const WorldState& now() const { return history.now(); }
  void start(EnvTask of, const WorldState& state);
  WorldStep step(const World& world, int action);
  // The network's input: writes World::observation_size() bytes.
  void observe(const World& world, int window, uint8_t* observation) const {
    world.observe(pair.env, history, window, observation);
  }
  // Of this one episode, whose last step was `last`.
  Outcomes outcome(const WorldStep& last) const;
};

}  // namespace synpo
