#include "stats/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace synpo {

Interval percentile_interval(std::vector<double> samples) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  if (samples.empty()) return {kNone, kNone};
  std::sort(samples.begin(), samples.end());
  if (samples.back() - samples.front() <= 1e-12 * (1 + std::abs(samples.front()))) return {kNone, kNone};
  return {quantile(samples, 0.025), quantile(samples, 0.975)};
}

Interval stratified_bootstrap(const std::vector<std::vector<double>>& pairs, const BootstrapPlan& plan) {
  std::vector<double> samples;
  for (int64_t i = 0; i < plan.samples && !pairs.empty(); ++i) {
    Random random(plan.seed, Purpose::kBootstrap, 0, uint64_t(i));
    double sum = 0;
    for (const std::vector<double>& values : pairs) {
      double pair_sum = 0;
      for (size_t k = 0; k < values.size(); ++k) pair_sum += values[random.below(uint32_t(values.size()))];
      sum += pair_sum / double(values.size());
    }
    samples.push_back(sum / double(pairs.size()));
  }
  return percentile_interval(std::move(samples));
}

}  // namespace synpo
