// What a policy would do wherever the agent stood.
#pragma once
#include <array>
#include <vector>

#include "policy/policy.h"
#include "world/grid/grid_set.h"

namespace synpo {

using ActionRates = std::array<double, kGridActions>;

// softmax(scores) of the policy, or the best action where scores are values (Policy::temperature()), with the agent on
// each free cell of the maze, in the order of Maze::free_cells; all else as in `state`. Its history is `pictures_each`
// times, 1 to kHistory, the picture of the agent there. The policy is prepared with `pair` as its pair number 0.
std::vector<ActionRates> probe_cells(Policy<float>& policy, const GridSet& world, EnvTask pair, const GridState& state,
                                     int window, int pictures_each);

}  // namespace synpo
