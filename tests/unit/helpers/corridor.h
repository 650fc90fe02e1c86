// A world as small as can be: a corridor of six cells, and a task at either end.
#pragma once
#include <cstdint>
#include <utility>

#include "base/random.h"
#include "world/observation.h"
#include "world/world.h"

namespace synpo {

class Corridor : public World {
 public:
  static constexpr int kCells = 6;
  static WorldFacts facts() {
    return {.name = "corridor",
            .environments = {{"short", 1, "short"}},
            .tasks = {"left", "right"},
            .actions = {"LEFT", "RIGHT"},
            .moves = 2,
            .state_bytes = 1,
            .observation = {.side = kCells, .palette = {{0, 0, 0}, {60, 60, 60}, {250, 250, 0}}}};
  }
  explicit Corridor(WorldFacts facts = Corridor::facts()) : World(std::move(facts)) {}

  WorldState reset(int, Random& random) const override { return at(1 + int(random.below(kCells - 2))); }
  WorldStep step(EnvTask pair, WorldState& state, int action) const override {
    state = at(state.bytes[0] + (action == 1 ? 1 : -1), state.steps + 1);
    const bool ends = state.bytes[0] == 0 || state.bytes[0] == kCells - 1;
    const bool success = ends && (state.bytes[0] > 0) == (pair.task == 1);
    return {success ? 99 : -1, ends, !ends && state.steps >= kStepLimit, success, ends && !success};
  }
  int expert(EnvTask pair, const WorldState&) const override { return pair.task; }
  void observe(int, const StateHistory& history, int, uint8_t* observation) const override {
    for (int i = 0; i < kCells * kCells * kHistory; ++i) {
      const int cell = i / kHistory % kCells, moment = i % kHistory;
      const bool missing = moment < kHistory - history.count;
      observation[i] = missing ? 0 : cell == history.states[size_t(moment)].bytes[0] ? 2 : 1;
    }
  }
  StartPlaces start_places(int, const WorldState& start) const override { return {{"agent", {0, start.bytes[0]}}}; }
  WorldState start_state(int, const StartPlaces& places) const override { return at(places.at("agent").second); }
  bool valid(EnvTask, const WorldState& state) const override { return state.bytes[0] < kCells; }

 private:
  static WorldState at(int cell, int steps = 0) {
    WorldState state;
    state.bytes[0] = uint8_t(cell);
    state.steps = uint16_t(steps);
    return state;
  }
};

}  // namespace synpo
