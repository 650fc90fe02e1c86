#include "draw/film.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "world/planner.h"

namespace synpo {
namespace {

std::string counted(int n, const char* one, const char* many) { return concat(n, " ", n == 1 ? one : many); }

// Steps from one key moment to the next, and the moments to be put between them.
struct Gap {
  int from, length, inside;
  double longest() const { return double(length) / (inside + 1); }
};

}  // namespace

Film play_film(const Maze& maze, const Task& task, const GridState& start, const std::vector<uint8_t>& actions, int radius) {
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
  const int last = film.steps() - 1;
  std::vector<int> chosen;
  const auto choose = [&](int moment) {
    if (int(chosen.size()) < count && std::find(chosen.begin(), chosen.end(), moment) == chosen.end()) chosen.push_back(moment);
  };
  choose(0);
  choose(last);
  for (int i = 0; i <= last; ++i)
    if (treasure_picked(film, i) >= 0) choose(i);
  std::sort(chosen.begin(), chosen.end());

  std::vector<Gap> gaps;
  for (size_t i = 1; i < chosen.size(); ++i) gaps.push_back({chosen[i - 1], chosen[i] - chosen[i - 1], 0});
  const int keys = int(chosen.size()), wanted = std::min(count, film.steps());
  if (gaps.empty()) return chosen;
  for (int i = keys; i < wanted; ++i)
    ++std::max_element(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.longest() < b.longest(); })->inside;
  for (const Gap& gap : gaps)
    for (int i = 1; i <= gap.inside; ++i) chosen.push_back(gap.from + gap.length * i / (gap.inside + 1));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string outcome(const Film& film) {
  const WorldStep& end = film.results.back();
  return end.success ? "success" : end.wrong ? "wrong pick" : end.truncated ? "timeout" : "unfinished";
}

std::string describe(const Film& film) {
  int cents = 0, bumps = 0, empty_picks = 0;
  std::string picks;
  for (int i = 0; i < film.steps(); ++i) {
    cents += film.results[i].reward_cents;
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
  char reward[32];
  std::snprintf(reward, sizeof reward, "%s%.2f", cents < 0 ? "\u2212" : "", std::abs(cents) / 100.0);
  std::string out = outcome(film) + " after " + counted(film.steps(), "step", "steps");
  const int fewest = Planner(film.maze).steps_to_success(film.task, film.states[0]);
  if (!film.results.back().success)
    out += concat(" (success takes ", fewest, ")");
  else
    out += film.steps() == fewest ? " (the fewest)" : concat(" (", fewest, " would do)");
  out += concat(", reward ", reward, picks.empty() ? "; no treasure picked" : picks);
  if (bumps > 0) out += "; " + counted(bumps, "step", "steps") + " into walls";
  if (empty_picks > 0) out += "; " + counted(empty_picks, "pick", "picks") + " where nothing lies";
  return out;
}

}  // namespace synpo
