#include "draw/face/episode_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/error.h"
#include "base/text.h"

namespace synpo {
namespace {

// Steps from one key moment to the next, and the moments to be put between them.
struct Gap {
  int from, length, inside;
  double longest() const { return double(length) / (inside + 1); }
};

}  // namespace

std::vector<int> spread_moments(int steps, const std::vector<int>& events, int count) {
  const int last = steps - 1;
  std::vector<int> chosen;
  const auto choose = [&](int moment) {
    if (int(chosen.size()) < count && std::find(chosen.begin(), chosen.end(), moment) == chosen.end())
      chosen.push_back(moment);
  };
  choose(0);
  choose(last);
  for (const int event : events) choose(event);
  std::sort(chosen.begin(), chosen.end());

  std::vector<Gap> gaps;
  for (size_t i = 1; i < chosen.size(); ++i) gaps.push_back({chosen[i - 1], chosen[i] - chosen[i - 1], 0});
  const int keys = int(chosen.size()), wanted = std::min(count, steps);
  if (gaps.empty()) return chosen;
  for (int i = keys; i < wanted; ++i)
    ++std::max_element(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
        return a.longest() < b.longest();
      })->inside;
  for (const Gap& gap : gaps)
    for (int i = 1; i <= gap.inside; ++i) chosen.push_back(gap.from + gap.length * i / (gap.inside + 1));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::string describe_end(const std::string& outcome, const std::vector<WorldStep>& results, int fewest) {
  const int steps = int(results.size());
  int cents = 0;
  for (const WorldStep& result : results) cents += result.reward_cents;
  char reward[32];
  std::snprintf(reward, sizeof reward, "%s%.2f", cents < 0 ? "\u2212" : "", std::abs(cents) / 100.0);
  std::string out = outcome + " after " + counted(steps, "step");
  if (fewest < 0) return out + ", reward " + reward;
  if (!results.back().success)
    out += concat(" (success takes ", fewest, ")");
  else
    out += steps == fewest ? " (the fewest)" : concat(" (", fewest, " would do)");
  return out + ", reward " + reward;
}

}  // namespace synpo
