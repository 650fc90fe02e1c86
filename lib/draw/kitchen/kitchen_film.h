// An episode in a kitchen that was played, every moment of it, and the words for what came of it.
#pragma once
#include <string>
#include <vector>

#include "world/kitchen/kitchen_set.h"

namespace synpo {

struct KitchenFilm {
  const KitchenSet& world;
  EnvTask pair;
  Kitchen kitchen;
  std::vector<WorldState> states;  // before every action, and after the last
  std::vector<uint8_t> actions;
  std::vector<WorldStep> results;  // of every action
  int steps() const { return int(actions.size()); }
  KitchenTask task() const { return kitchen_task(pair.task); }
  KitchenFrame frame(int moment) const { return world.frame(pair.env, states[size_t(moment)]); }
  std::string name() const { return kitchen.name + ", task " + task().name(); }
};

// Plays the actions from the start; at least one.
KitchenFilm play_kitchen_film(const KitchenSet& world, EnvTask pair, const WorldState& start,
                              const std::vector<uint8_t>& actions);

// What an action did to a thing: an object for kPicked, else a receptacle.
enum class Deed : uint8_t { kNone, kOpened, kClosed, kPicked, kPut };
struct KitchenEvent {
  Deed deed = Deed::kNone;
  int thing = -1;
};
// Of action number `i`, from 0.
KitchenEvent event_of(const KitchenFilm& film, int i);

// Actions: spread_moments() with those that open, close, pick up or put.
std::vector<int> key_moments(const KitchenFilm& film, int count);

// "success", "wrong object", "wrong receptacle", "timeout" or, where the actions end before the episode does,
// "unfinished".
std::string outcome(const KitchenFilm& film);
// "success after 18 steps (the fewest), reward 10.82; Mug at step 9, Fridge opened at step 17, filled at step 18; 2
// steps without effect"
std::string describe(const KitchenFilm& film);
// An action by what it did: "MoveAhead", "open Fridge", "pick Mug", "put in Sink"; its name where it did nothing.
std::string action_words(const KitchenFilm& film, int i);

}  // namespace synpo
