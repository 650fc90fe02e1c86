// Percentile bootstrap intervals (Efron 1979).
#pragma once
#include <cstdint>
#include <vector>

#include "stats/interval.h"

namespace synpo {

struct BootstrapPlan {
  int64_t samples = 2000;
  uint64_t seed = 1;
};

// 2.5 % and 97.5 % points of the samples; NaN for none, or where they are all one value, which says nothing about the
// spread.
Interval percentile_interval(std::vector<double> samples);

// 95 % interval for the mean over pairs of the mean of a pair's values, one for each run. In each pair on its own as
// many values are drawn as there are, the pairs being the strata (Agarwal et al. 2021). No pair is empty, and no value
// NaN. NaN where no pair has two values.
Interval stratified_bootstrap(const std::vector<std::vector<double>>& pairs, const BootstrapPlan& plan);

}  // namespace synpo
