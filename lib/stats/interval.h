// Confidence intervals, means and standard deviations.
#pragma once
#include <cstdint>
#include <vector>

namespace synpo {

struct Interval {
  double low, high;
};

constexpr double kNormal95 = 1.959963984540054;  // the normal distribution's 97.5 % point

// Wilson's score interval (1927) for the rate behind k successes in n trials; n = 0 gives [0, 1].
//   (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),  p = k/n
Interval wilson(int64_t k, int64_t n, double z = kNormal95);

struct MeanSd {
  int64_t count = 0;
  double mean = 0;  // NaN for no values
  double sd = 0;    // divisor count - 1; NaN for fewer than two values
};
MeanSd mean_sd(const std::vector<double>& values);

}  // namespace synpo
