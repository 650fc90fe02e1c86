#include "stats/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace synpo {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// How often each of `count` is drawn in as many draws with replacement.
std::vector<double> draw_weights(size_t count, Random& random) {
  std::vector<double> weights(count, 0);
  for (size_t i = 0; i < count; ++i) ++weights[random.below(uint32_t(count))];
  return weights;
}

// NaN where no run that was drawn has the pair.
double weighted_mean(const std::vector<RunValue>& values, const std::vector<double>& weights) {
  double sum = 0, weight = 0;
  for (const RunValue& v : values) {
    sum += weights[v.run] * v.value;
    weight += weights[v.run];
  }
  return weight > 0 ? sum / weight : kNone;
}

std::vector<double> run_means(const PairValues& pairs, size_t runs) {
  std::vector<double> sums(runs, 0), counts(runs, 0), means;
  for (const auto& values : pairs) {
    for (const RunValue& v : values) {
      sums[v.run] += v.value;
      ++counts[v.run];
    }
  }
  for (size_t r = 0; r < runs; ++r)
    if (counts[r] > 0) means.push_back(sums[r] / counts[r]);
  return means;
}

double mean_of_draws(const std::vector<double>& values, Random& random) {
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) sum += values[random.below(uint32_t(values.size()))];
  return sum / double(values.size());
}

}  // namespace

Interval percentile_interval(std::vector<double> samples) {
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  if (samples.empty()) return {kNone, kNone};
  std::sort(samples.begin(), samples.end());
  if (samples.back() - samples.front() <= 1e-12 * (1 + std::abs(samples.front()))) return {kNone, kNone};
  return {quantile(samples, 0.025), quantile(samples, 0.975)};
}

Interval bootstrap_mean(const PairValues& pairs, size_t runs, const BootstrapPlan& plan) {
  const std::vector<double> means = run_means(pairs, runs);
  if (means.size() < 2) return {kNone, kNone};
  std::vector<double> samples;
  for (int64_t i = 0; i < plan.samples; ++i) {
    Random random(plan.seed, Purpose::kBootstrap, 0, uint64_t(i));
    if (!plan.pair_by_pair) {
      samples.push_back(mean_of_draws(means, random));
      continue;
    }
    double sum = 0;
    for (const auto& values : pairs) {
      double pair_sum = 0;
      for (size_t k = 0; k < values.size(); ++k) pair_sum += values[random.below(uint32_t(values.size()))].value;
      sum += pair_sum / double(values.size());
    }
    samples.push_back(sum / double(pairs.size()));
  }
  return percentile_interval(std::move(samples));
}

Interval bootstrap_difference(const PairValues& a, size_t runs_a, const PairValues& b, size_t runs_b, bool matched,
                              const BootstrapPlan& plan) {
  std::vector<double> samples;
  if (a.empty()) return {kNone, kNone};
  for (int64_t i = 0; i < plan.samples; ++i) {
    Random random(plan.seed, Purpose::kBootstrap, 1, uint64_t(i));
    const std::vector<double> weights_a = draw_weights(runs_a, random);
    const std::vector<double> weights_b = matched ? weights_a : draw_weights(runs_b, random);
    const std::vector<double> pair_weights = draw_weights(a.size(), random);
    double sum = 0, weight = 0;
    for (size_t p = 0; p < a.size(); ++p) {
      if (pair_weights[p] == 0) continue;
      const double difference = weighted_mean(b[p], weights_b) - weighted_mean(a[p], weights_a);
      if (std::isnan(difference)) continue;
      sum += pair_weights[p] * difference;
      weight += pair_weights[p];
    }
    samples.push_back(weight > 0 ? sum / weight : kNone);
  }
  return percentile_interval(std::move(samples));
}

}  // namespace synpo
