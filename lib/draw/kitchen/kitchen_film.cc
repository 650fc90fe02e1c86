#include "draw/kitchen/kitchen_film.h"

#include "base/error.h"
#include "draw/episode/episode_words.h"
#include "draw/kitchen/kitchen_moment.h"

namespace synpo {

KitchenFilm play_kitchen_film(const KitchenSet& world, EnvTask pair, const WorldState& start,
                              const std::vector<uint8_t>& actions) {
  KitchenFilm film{world, pair, kitchen_of(world, pair.env), {start}, actions, {}};
  WorldState state = start;
  for (const uint8_t action : actions) {
    film.results.push_back(world.step(pair, state, action));
    film.states.push_back(state);
  }
  return film;
}

KitchenEvent event_of(const KitchenFilm& film, int i) {
  const KitchenState before = unpack(film.states[size_t(i)]), after = unpack(film.states[size_t(i) + 1]);
  for (int door = 0; door < kKitchenDoors; ++door)
    if ((before.doors ^ after.doors) >> door & 1)
      return {after.doors >> door & 1 ? Deed::kOpened : Deed::kClosed, door};
  if (before.hand == after.hand) return {};
  if (before.hand == kEmptyHand) return {Deed::kPicked, after.hand};
  return {Deed::kPut, receptacle_in_reach(film.world.tables(film.pair.env), before.pose, before.doors)};
}

std::vector<int> key_moments(const KitchenFilm& film, int count) {
  std::vector<int> deeds;
  for (int i = 0; i < film.steps(); ++i)
    if (event_of(film, i).deed != Deed::kNone) deeds.push_back(i);
  return spread_moments(film.steps(), deeds, count);
}

std::string outcome(const KitchenFilm& film) {
  const WorldStep& end = film.results.back();
  if (end.wrong) return event_of(film, film.steps() - 1).deed == Deed::kPicked ? "wrong object" : "wrong receptacle";
  return end.success ? "success" : end.truncated ? "timeout" : "unfinished";
}

std::string describe(const KitchenFilm& film) {
  std::string deeds;
  int without_effect = 0;
  for (int i = 0; i < film.steps(); ++i) {
    const auto add = [&](const char* name, const char* what) {
      deeds += concat(deeds.empty() ? "; " : ", ", name, what, " at step ", i + 1);
    };
    const KitchenEvent event = event_of(film, i);
    switch (event.deed) {
      case Deed::kNone:
        without_effect += film.results[size_t(i)].reward_cents == kStepCents + kInvalidCents;
        break;
      case Deed::kOpened:
        add(kKitchenReceptacleNames[event.thing], " opened");
        break;
      case Deed::kClosed:
        add(kKitchenReceptacleNames[event.thing], " closed");
        break;
      case Deed::kPicked:
        add(kKitchenObjectNames[event.thing], "");
        break;
      case Deed::kPut:
        add(kKitchenReceptacleNames[event.thing], " filled");
        break;
    }
  }
  const int fewest = film.world.planner(film.pair.env).steps_to_success(film.task(), unpack(film.states[0]));
  std::string out = describe_end(outcome(film), film.results, fewest) + (deeds.empty() ? "; nothing picked up" : deeds);
  if (without_effect > 0) out += "; " + counted(without_effect, "step", "steps") + " without effect";
  return out;
}

std::string action_words(const KitchenFilm& film, int i) {
  const KitchenEvent event = event_of(film, i);
  switch (event.deed) {
    case Deed::kOpened:
      return concat("open ", kKitchenReceptacleNames[event.thing]);
    case Deed::kClosed:
      return concat("close ", kKitchenReceptacleNames[event.thing]);
    case Deed::kPicked:
      return concat("pick ", kKitchenObjectNames[event.thing]);
    case Deed::kPut:
      return concat("put in ", kKitchenReceptacleNames[event.thing]);
    default:
      return kKitchenActionNames[film.actions[size_t(i)]];
  }
}

}  // namespace synpo
