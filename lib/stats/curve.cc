#include "stats/curve.h"

#include <algorithm>

#include "base/error.h"

namespace synpo {

double value_at(const Curve& curve, double x) {
  const size_t right = size_t(std::lower_bound(curve.x.begin(), curve.x.end(), x) - curve.x.begin());
  if (curve.x[right] == x) return curve.y[right];
  const double share = (x - curve.x[right - 1]) / (curve.x[right] - curve.x[right - 1]);
  return curve.y[right - 1] + share * (curve.y[right] - curve.y[right - 1]);
}

Curve running_mean(const Curve& curve, int64_t points) {
  Curve out = curve;
  for (size_t i = 0; i < curve.y.size(); ++i) {
    const size_t first = i + 1 > size_t(points) ? i + 1 - size_t(points) : 0;
    double sum = 0;
    for (size_t k = first; k <= i; ++k) sum += curve.y[k];
    out.y[i] = sum / double(i + 1 - first);
  }
  return out;
}

MeanCurve mean_curve(const std::vector<Curve>& runs, Band band, const Interval& bounds) {
  MeanCurve out;
  out.runs = int64_t(runs.size());
  out.longest = runs.front().x.back();
  double first = runs.front().x.front(), last = out.longest;
  for (const Curve& run : runs) {
    first = std::max(first, run.x.front());
    last = std::min(last, run.x.back());
    out.longest = std::max(out.longest, run.x.back());
    out.x.insert(out.x.end(), run.x.begin(), run.x.end());
  }
  if (first > last)
    fail(Exit::kData, "the runs have no stretch in common: one begins at ", first, ", another ends at ", last);
  std::sort(out.x.begin(), out.x.end());
  out.x.erase(std::unique(out.x.begin(), out.x.end()), out.x.end());
  std::erase_if(out.x, [&](double x) { return x < first || x > last; });
  for (const double x : out.x) {
    std::vector<double> values;
    for (const Curve& run : runs) values.push_back(value_at(run, x));
    const MeanSd moments = mean_sd(values);
    out.mean.push_back(moments.mean);
    if (band == Band::kNone || runs.size() < 2) continue;
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    out.low.push_back(band == Band::kSd ? std::max(bounds.low, moments.mean - moments.sd) : *lowest);
    out.high.push_back(band == Band::kSd ? std::min(bounds.high, moments.mean + moments.sd) : *highest);
  }
  return out;
}

}  // namespace synpo
