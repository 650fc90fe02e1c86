#include "learn/ppo/gae.h"

#include <cstddef>

namespace synpo {

std::vector<float> advantages(const GaeInput& input, const GaeOptions& options) {
  std::vector<float> advantage(size_t(input.steps) * input.lanes);
  for (int lane = 0; lane < input.lanes; ++lane) {
    double following = 0;
    for (int t = input.steps - 1; t >= 0; --t) {
      const size_t at = size_t(t) * input.lanes + lane;
      const bool last = t == input.steps - 1;
      const double next_value = input.end[at] == StepEnd::kTerminated  ? 0
                                : input.end[at] == StepEnd::kTruncated ? input.cut_value[at]
                                : last                                 ? input.last_value[lane]
                                                                       : input.value[at + input.lanes];
      const double delta = input.reward[at] + options.discount * next_value - input.value[at];
      following = delta + (input.end[at] == StepEnd::kGoesOn ? options.discount * options.lambda * following : 0);
      advantage[at] = float(following);
    }
  }
  return advantage;
}

}  // namespace synpo
