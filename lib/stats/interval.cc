#include "stats/interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace synpo {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The regularised incomplete beta function I_x(a, b), by its continued fraction, from the inside out.
double incomplete_beta(double a, double b, double x) {
  if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);  // where the fraction converges fast
  double fraction = 1;
  for (int m = 40; m >= 1; --m) {
    fraction = 1 + m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)) / fraction;
    fraction = 1 - (a + m - 1) * (a + b + m - 1) * x / ((a + 2 * m - 2) * (a + 2 * m - 1)) / fraction;
  }
  const double log_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  return std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta) / (a * fraction);
}

}  // namespace

Interval wilson(int64_t k, int64_t n, double z) {
  return n > 0 ? wilson_of_rate(double(k) / double(n), double(n), z) : Interval{0, 1};
}

Interval wilson_of_rate(double rate, double trials, double z) {
  const double z2n = z * z / trials;
  const double centre = rate + z2n / 2;
  const double half = z * std::sqrt(rate * (1 - rate) / trials + z2n / trials / 4);
  // Of a rate of 0 or 1 one end is 0 or 1 exactly; rounding must not hide that.
  return {rate == 0 ? 0 : std::max(0.0, (centre - half) / (1 + z2n)),
          rate == 1 ? 1 : std::min(1.0, (centre + half) / (1 + z2n))};
}

Interval newcombe(int64_t k1, int64_t n1, int64_t k2, int64_t n2, double z) {
  return newcombe_of_rates(double(k1) / double(n1), double(n1), double(k2) / double(n2), double(n2), z);
}

Interval newcombe_of_rates(double rate1, double trials1, double rate2, double trials2, double z) {
  const Interval one = wilson_of_rate(rate1, trials1, z), two = wilson_of_rate(rate2, trials2, z);
  const double difference = rate1 - rate2;
  return {difference - std::hypot(rate1 - one.low, two.high - rate2),
          difference + std::hypot(one.high - rate1, rate2 - two.low)};
}

double student95(double df) {
  constexpr double z = kNormal95, z3 = z * z * z;
  // Cornish and Fisher's expansion (1937); the next term is below 1e-8.
  if (df > 500) return z + (z3 + z) / (4 * df) + (5 * z3 * z * z + 16 * z3 + 3 * z) / (96 * df * df);
  // With x = df / (df + t^2), |T| > t has the probability I_x(df / 2, 1 / 2).
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double x = (low + high) / 2;
    (incomplete_beta(df / 2, 0.5, x) < 0.05 ? low : high) = x;
  }
  return std::sqrt(df * (1 - low) / low);
}

bool alike(const MeanSd& values) { return values.sd <= 1e-12 * (1 + std::abs(values.mean)); }

Interval student(const MeanSd& values) {
  if (!(values.sd > 0) || alike(values)) return {kNone, kNone};
  const double half = student95(double(values.count - 1)) * values.sd / std::sqrt(double(values.count));
  return {values.mean - half, values.mean + half};
}

Interval hull(const Interval& a, const Interval& b) {
  if (std::isnan(a.low)) return b;
  if (std::isnan(b.low)) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

MeanSd mean_sd(const std::vector<double>& values) {
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
  if (values.empty() || std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return kNone;
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
