#include "draw/grid/film.h"

#include "base/error.h"
#include "draw/episode/episode_words.h"
#include "world/grid/planner.h"

namespace synpo {

Film play_film(const Maze& maze, const Task& task, const GridState& start, const std::vector<uint8_t>& actions,
               int radius) {
  Film film{maze, task, radius, {start}, actions, {}};
  GridState state = start;
  for (const uint8_t action : actions) {
    film.results.push_back(grid_step(maze, task, state, action));
    film.states.push_back(state);
  }
  return film;
}

int treasure_picked(const Film& film, int i) {
  return film.actions[i] == kPick ? treasure_under_agent(film.states[i].now) : -1;
}

std::vector<int> key_moments(const Film& film, int count) {
  std::vector<int> picks;
  for (int i = 0; i < film.steps(); ++i)
    if (treasure_picked(film, i) >= 0) picks.push_back(i);
  return spread_moments(film.steps(), picks, count);
}

std::string outcome(const Film& film) {
  const WorldStep& end = film.results.back();
  return end.success ? "success" : end.wrong ? "wrong pick" : end.truncated ? "timeout" : "unfinished";
}

std::string describe(const Film& film) {
  int bumps = 0, empty_picks = 0;
  std::string picks;
  for (int i = 0; i < film.steps(); ++i) {
    if (film.actions[i] == kPick) {
      const int treasure = treasure_picked(film, i);
      if (treasure < 0)
        ++empty_picks;
      else
        picks += concat(picks.empty() ? "; " : ", ", kTreasureLetters[treasure], " at step ", i + 1);
    } else if (film.states[i].now.agent == film.states[i + 1].now.agent) {
      ++bumps;
    }
  }
  const int fewest = Planner(film.maze).steps_to_success(film.task, film.states[0]);
  std::string out =
      describe_end(outcome(film), film.results, fewest) + (picks.empty() ? "; no treasure picked" : picks);
  if (bumps > 0) out += "; " + counted(bumps, "step", "steps") + " into walls";
  if (empty_picks > 0) out += "; " + counted(empty_picks, "pick", "picks") + " where nothing lies";
  return out;
}

}  // namespace synpo
