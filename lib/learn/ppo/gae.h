// Generalised advantage estimation (Schulman et al. 2016), for worlds that run side by side.
#pragma once
#include <cstdint>
#include <vector>

namespace synpo {

// How a step left its episode.
enum class StepEnd : uint8_t { kGoesOn, kTerminated, kTruncated };

struct GaeOptions {
  double discount = 0.99, lambda = 0.95;
};

// All of [steps, lanes], a lane one world. `last_value` [lanes] is the value of the state after the last step;
// `cut_value` that of the state that a truncated step led to, read there alone.
struct GaeInput {
  int steps, lanes;
  const float* reward;
  const float* value;
  const StepEnd* end;
  const float* cut_value;
  const float* last_value;
};

// delta_t = r_t + gamma V(s_t+1) - V(s_t), where V is 0 after a terminal step; advantage_t = delta_t + gamma lambda
// advantage_t+1, where nothing comes from after an episode's end. A step's return is advantage + value.
std::vector<float> advantages(const GaeInput& input, const GaeOptions& options);

}  // namespace synpo
