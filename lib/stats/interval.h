// Confidence intervals, means and standard deviations.
#pragma once
#include <cstdint>
#include <vector>

namespace synpo {

struct Interval {
  double low, high;
};

constexpr double kNormal95 = 1.959963984540054;  // the normal distribution's 97.5 % point

// Wilson's score interval (1927) for the rate that gave k successes in n trials; n = 0 gives [0, 1].
//   (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),  p = k/n
Interval wilson(int64_t k, int64_t n, double z = kNormal95);
// The same for a mean of rates that is as sure as one rate in `trials` trials, a number that need not be whole; > 0.
Interval wilson_of_rate(double rate, double trials, double z = kNormal95);

// Newcombe's hybrid score interval (1998, method 10) for the difference p1 - p2 of the rates that gave k1 of n1 and k2
// of n2, made of Wilson's intervals l to u of each:
//   d - sqrt((p1 - l1)^2 + (u2 - p2)^2)  to  d + sqrt((u1 - p1)^2 + (p2 - l2)^2),  d = p1 - p2
// The trials of one are taken as independent of those of the other. n1, n2 > 0.
Interval newcombe(int64_t k1, int64_t n1, int64_t k2, int64_t n2, double z = kNormal95);
// The same for means of rates, as wilson_of_rate().
Interval newcombe_of_rates(double rate1, double trials1, double rate2, double trials2, double z = kNormal95);

// The 97.5 % point of Student's t distribution with `df` degrees of freedom, which need not be whole; df > 0.
double student95(double df);

struct MeanSd {
  int64_t count = 0;
  double mean = 0;  // NaN for no values
  double sd = 0;    // divisor count - 1; NaN for fewer than two values
};
MeanSd mean_sd(const std::vector<double>& values);
// Whether there are several values, which differ by no more than rounding.
bool alike(const MeanSd& values);

// Student's 95 % interval (1908) for the mean of what the values were drawn from: mean +- t sd / sqrt(count), with
// count - 1 degrees of freedom. NaN for fewer than two values, or where they are alike, which says nothing of the
// spread.
Interval student(const MeanSd& values);

// From the lower of both low ends to the higher of both high ends; the other one where one is NaN.
Interval hull(const Interval& a, const Interval& b);

// Mean of the values that are left when a quarter of them, rounded down, is taken away at either end (Agarwal et al.
// 2021; a trimmed mean of 25 %). NaN for no values or where one is NaN.
double interquartile_mean(std::vector<double> values);

// The q-quantile with linear interpolation between order statistics (Hyndman and Fan's type 7, the default of R and
// NumPy). `sorted` is in rising order and not empty; q in [0, 1].
double quantile(const std::vector<double>& sorted, double q);

}  // namespace synpo
