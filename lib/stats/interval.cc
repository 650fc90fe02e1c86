#include "stats/interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace synpo {

Interval wilson(int64_t k, int64_t n, double z) {
  if (n <= 0) return {0, 1};
  const double rate = double(k) / double(n), z2n = z * z / double(n);
  const double centre = rate + z2n / 2;
  const double half = z * std::sqrt(rate * (1 - rate) / double(n) + z2n / double(n) / 4);
  // At k = 0 and k = n one end is 0 or 1 exactly; rounding must not hide that.
  return {k == 0 ? 0 : std::max(0.0, (centre - half) / (1 + z2n)), k == n ? 1 : std::min(1.0, (centre + half) / (1 + z2n))};
}

MeanSd mean_sd(const std::vector<double>& values) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  MeanSd result{int64_t(values.size()), kNone, kNone};
  if (values.empty()) return result;
  double sum = 0;
  for (double value : values) sum += value;
  result.mean = sum / double(values.size());
  if (values.size() < 2) return result;
  double squares = 0;
  for (double value : values) squares += (value - result.mean) * (value - result.mean);
  result.sd = std::sqrt(squares / double(values.size() - 1));
  return result;
}

}  // namespace synpo
