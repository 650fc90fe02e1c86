#include "draw/face/film.h"

#include "base/error.h"

namespace synpo {
namespace {

void play(Film& film, int action) {
  WorldState state = film.states.back();
  film.actions.push_back(uint8_t(action));
  film.results.push_back(film.world.step(film.pair, state, action));
  film.states.push_back(state);
}

}  // namespace

Film play_film(const World& world, EnvTask pair, const WorldState& start, const std::vector<uint8_t>& actions,
               int window) {
  Film film{world, pair, window, {start}, {}, {}};
  for (const uint8_t action : actions) play(film, action);
  return film;
}

Film expert_film(const World& world, EnvTask pair, Random random, int64_t steps, int window) {
  Film film{world, pair, window, {world.reset(pair.env, random)}, {}, {}};
  for (int64_t i = 0; i < steps; ++i) {
    if (film.terminated()) fail(Exit::kUsage, "the expert's episode ends after ", i, " steps, before step ", steps);
    play(film, world.expert(pair, film.states.back()));
  }
  return film;
}

int expert_steps(const World& world, EnvTask pair, WorldState state) {
  for (int steps = 1; steps <= kStepLimit; ++steps)
    if (const WorldStep result = world.step(pair, state, world.expert(pair, state)); result.ended())
      return result.success ? steps : -1;
  return -1;
}

}  // namespace synpo
