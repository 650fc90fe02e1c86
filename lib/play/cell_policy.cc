#include "play/cell_policy.h"

#include <algorithm>
#include <cmath>

#include "nn/softmax.h"

namespace synpo {
namespace {

// What the policy would do, as it acts by itself: by chance, or, where scores are values, the best action.
ActionRates rates_of(const float* scores, bool values) {
  ActionRates rates = {};
  if (!values) {
    softmax(scores, kGridActions, 1, rates.data());
    return rates;
  }
  const float top = *std::max_element(scores, scores + kGridActions);
  const auto best = std::count(scores, scores + kGridActions, top);
  for (int a = 0; a < kGridActions; ++a) rates[a] = scores[a] == top ? 1.0 / double(best) : 0;
  return rates;
}

}  // namespace

std::vector<ActionRates> probe_cells(Policy<float>& policy, const GridSet& world, EnvTask pair, const GridState& state,
                                     int window, int pictures_each) {
  constexpr size_t kMost = Policy<float>::kInferenceUnit;
  const size_t picture = world.observation_size();
  const Maze& maze = world.maze(pair.env);
  std::vector<uint8_t> pictures(kMost * picture);
  std::vector<float> scores(kMost * kGridActions);
  const std::vector<int> pair_of(kMost, 0);
  std::vector<ActionRates> rates;
  for (size_t first = 0; first < maze.free_cells.size(); first += kMost) {
    const size_t size = std::min(kMost, maze.free_cells.size() - first);
    for (size_t i = 0; i < size; ++i) {
      GridState here = state;
      here.now.agent = maze.free_cells[first + i];
      StateHistory history;
      for (int k = 0; k < pictures_each; ++k) history.push(to_world_state(here));
      world.observe(pair.env, history, window, pictures.data() + i * picture);
    }
    policy.infer(0, int(size), pictures.data(), pair_of.data(), scores.data());
    for (size_t i = 0; i < size; ++i)
      rates.push_back(rates_of(scores.data() + i * kGridActions, policy.temperature() == 0));
  }
  return rates;
}

}  // namespace synpo
