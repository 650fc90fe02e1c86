#include "stats/chance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/interval.h"

namespace synpo {
namespace {

// The probabilities of k successes in n trials at a rate between 0 and 1, where they are not next to nothing.
struct Binomial {
  int64_t n, first;
  std::vector<double> below;  // below[i]: of fewer than first + i successes; one more than there are counts

  Binomial(double rate, int64_t trials) : n(trials) {
    const double mean = double(n) * rate, reach = 9 * std::sqrt(mean * (1 - rate)) + 20;
    first = std::max<int64_t>(0, int64_t(mean - reach));
    const int64_t last = std::min<int64_t>(n, int64_t(mean + reach));
    below = {0};
    for (int64_t k = first; k <= last; ++k)
      below.push_back(below.back() + std::exp(std::lgamma(double(n) + 1) - std::lgamma(double(k) + 1) -
                                              std::lgamma(double(n - k) + 1) + double(k) * std::log(rate) +
                                              double(n - k) * std::log1p(-rate)));
  }
  size_t counts() const { return below.size() - 1; }
};

}  // namespace

double newcombe_false_alarms(double rate, int64_t n1, int64_t n2) {
  constexpr double kMany = 5000, kEnough = 100000;
  const double spread = rate * (1 - rate);
  if (!(spread > 0)) return 0;
  if (double(std::min(n1, n2)) * spread > kMany) return 0.05;
  // More trials of one side than this change nothing: the other decides.
  const auto most = int64_t(std::min(1e15, kEnough / spread));
  const Binomial one(rate, std::min(n1, most)), two(rate, std::min(n2, most));
  // The more successes in one, the more it takes in two: both bounds only rise.
  size_t lower = 0, upper = 0;
  double sum = 0;
  for (size_t i = 0; i < one.counts(); ++i) {
    const auto interval = [&](size_t j) {
      return newcombe(one.first + int64_t(i), one.n, two.first + int64_t(j), two.n);
    };
    while (lower < two.counts() && interval(lower).low > 0) ++lower;
    while (upper < two.counts() && !(interval(upper).high < 0)) ++upper;
    sum += (one.below[i + 1] - one.below[i]) * (two.below[lower] + two.below.back() - two.below[upper]);
  }
  return sum;
}

}  // namespace synpo
