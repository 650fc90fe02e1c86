// Curves over several runs: their mean and a band around it, on grids that need not agree.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "stats/interval.h"

namespace synpo {

struct Curve {
  std::vector<double> x, y;  // x rises strictly
};

// Linear between the points. `x` lies from the first point to the last.
double value_at(const Curve& curve, double x);

// Each value becomes the mean of itself and of up to `points` - 1 values before it.
Curve running_mean(const Curve& curve, int64_t points);

enum class Band { kNone, kSd, kRange };

struct MeanCurve {
  std::vector<double> x, mean;
  std::vector<double> low, high;  // of the band; empty where no band is drawn: one run, or Band::kNone
  int64_t runs = 0;
  double longest = 0;  // the last x of the longest run; the mean ends with the shortest
};

// The mean at every x of any run, where all runs have values. kSd is the standard deviation with divisor runs - 1 to
// either side, but no further than the values can be: `bounds`. kRange reaches from the lowest run to the highest. No
// curve may be empty. Throws kData where the runs have no x in common.
MeanCurve mean_curve(const std::vector<Curve>& runs, Band band,
                     const Interval& bounds = {-std::numeric_limits<double>::infinity(),
                                               std::numeric_limits<double>::infinity()});

}  // namespace synpo
