// An episode under way: where it stands and what the agent remembers of it.
#pragma once
#include <cstdint>
#include <vector>

#include "world/world.h"

namespace synpo {

struct RunningEpisode {
  EnvTask pair = {0, 0};
  StateHistory history;  // the newest is where it stands

  const WorldState& now() const { return history.now(); }
  void start(EnvTask of, const WorldState& state) {
    pair = of;
    history = {};
    history.push(state);
  }
  WorldStep step(const World& world, int action) {
    WorldState state = now();
    const WorldStep result = world.step(pair, state, action);
    history.push(state);
    return result;
  }

  // As bytes of a checkpoint, kBytes behind `to`.
  static constexpr size_t kBytes = 4 + 1 + kHistory * (std::tuple_size_v<decltype(WorldState::bytes)> + 2);
  void save(std::vector<uint8_t>& to) const;
  // False for bytes that no running episode of this world gives.
  bool load(const World& world, const uint8_t* from);
};

}  // namespace synpo
