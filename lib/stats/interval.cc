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
  return {k == 0 ? 0 : std::max(0.0, (centre - half) / (1 + z2n)),
          k == n ? 1 : std::min(1.0, (centre + half) / (1 + z2n))};
}

Interval newcombe(int64_t k1, int64_t n1, int64_t k2, int64_t n2, double z) {
  const double p1 = double(k1) / double(n1), p2 = double(k2) / double(n2);
  const Interval one = wilson(k1, n1, z), two = wilson(k2, n2, z);
  return {p1 - p2 - std::hypot(p1 - one.low, two.high - p2), p1 - p2 + std::hypot(one.high - p1, p2 - two.low)};
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

double interquartile_mean(std::vector<double> values) {
  // NaN has no place in an order.
  if (values.empty() || std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }))
    return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const auto cut = std::ptrdiff_t(values.size() / 4);
  return mean_sd({values.begin() + cut, values.end() - cut}).mean;
}

double quantile(const std::vector<double>& sorted, double q) {
  const double at = q * double(sorted.size() - 1);
  const size_t below = size_t(at), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

}  // namespace synpo
