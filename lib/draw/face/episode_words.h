// Episodes in words, whatever their world: how they ended, and which of their moments are worth showing.
#pragma once
#include <string>
#include <vector>

#include "world/world.h"

namespace synpo {

// Of `steps` actions, numbered from 0, at most `count`, rising: the first, the last and `events`, and others as evenly
// between them as can be. Where `count` is below the number of the former, the first, the last and then the earliest
// events come before others.
std::vector<int> spread_moments(int steps, const std::vector<int>& events, int count);

// "success after 41 steps (39 would do), reward 11.60"; `fewest` steps are what the planner takes,
// -1 where that is not known.
std::string describe_end(const std::string& outcome, const std::vector<WorldStep>& results, int fewest);

}  // namespace synpo
