// Percentile bootstrap intervals (Efron 1979) for means over runs and pairs.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stats/interval.h"

namespace synpo {

struct BootstrapPlan {
  int64_t samples = 2000;
  uint64_t seed = 1;
  // How runs are drawn for a mean. False: whole runs, with all their pairs. True: in each pair on its own, the pairs
  // being the strata (Agarwal et al. 2021).
  bool pair_by_pair = false;
};

// A run's value on a pair.
struct RunValue {
  uint32_t run;
  double value;
};
// The values of each pair; no pair is empty, and no value NaN.
using PairValues = std::vector<std::vector<RunValue>>;

// 2.5 % and 97.5 % points of the samples; NaN for none, or where they are all one value, which says nothing about the
// spread.
Interval percentile_interval(std::vector<double> samples);

// 95 % interval for the mean over `runs` runs of each run's mean over its pairs. NaN for fewer than two runs.
Interval bootstrap_mean(const PairValues& pairs, size_t runs, const BootstrapPlan& plan);

// 95 % interval for the mean over pairs of (mean over b's runs - mean over a's runs); a[i] and b[i] are the same pair.
// Pairs are drawn together for a and b. So are runs when `matched`, run i of a with run i of b; otherwise each side
// draws its own.
Interval bootstrap_difference(const PairValues& a, size_t runs_a, const PairValues& b, size_t runs_b, bool matched,
                              const BootstrapPlan& plan);

}  // namespace synpo
