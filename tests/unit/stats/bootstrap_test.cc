#include "stats/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace synpo {
namespace {

// A quarter, rounded down, cut off at either end: Agarwal et al. 2021, footnote on scipy's trim_mean with 0.25.
TEST(InterquartileMean, HandComputed) {
  EXPECT_DOUBLE_EQ(interquartile_mean({5, 8, 4, 38, 8, 6, 9, 7, 7, 3, 1, 6}), 6.5);  // of 5 6 6 7 7 8
  EXPECT_DOUBLE_EQ(interquartile_mean({1, 100, 3}), 104.0 / 3);                      // too few to cut
  EXPECT_DOUBLE_EQ(interquartile_mean({9, 1, 2, 4, 100}), 5);                        // of 2 4 9
  EXPECT_TRUE(std::isnan(interquartile_mean({})));
  EXPECT_TRUE(std::isnan(interquartile_mean({1, NAN, 2})));
}

// R: quantile(1:4, c(0.25, 0.5)); NumPy: percentile([15, 20, 35, 40, 50], 40).
TEST(Quantile, TypeSeven) {
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4}, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({15, 20, 35, 40, 50}, 0.4), 29);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.975), 7);
  EXPECT_DOUBLE_EQ(quantile({1, 2}, 1), 2);
}

// All samples of few runs can be counted out.
TEST(Bootstrap, FewRunsCountedOut) {
  const Interval two = stratified_bootstrap({{0, 1}}, {});  // 0 and 1 in 1 of 4 samples each
  EXPECT_EQ(two.low, 0);
  EXPECT_EQ(two.high, 1);
  // The mean is the number of fours: binomial (4, 1/4), P(4) = 0.4 %, P(3 or 4) = 5.1 %.
  const Interval four = stratified_bootstrap({{0, 4, 0, 0}}, {10000, 1});
  EXPECT_EQ(four.low, 0);
  EXPECT_EQ(four.high, 3);
  EXPECT_TRUE(std::isnan(stratified_bootstrap({{0.3}}, {}).low)) << "one run says nothing of others";
  EXPECT_TRUE(std::isnan(stratified_bootstrap({{1, 1, 1}}, {}).low)) << "nor do runs that are all alike";
}

// Efron 1979: the bootstrap's standard error of a mean of n is sqrt((n - 1) / n) sd / sqrt(n).
TEST(Bootstrap, ManyRunsAsTheFormulaHasIt) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i % 10);
  const Interval interval = stratified_bootstrap({values}, {20000, 3});
  const double half = 1.96 * std::sqrt(8.25) / 10;  // the variance of 0 to 9 with divisor n
  EXPECT_NEAR(interval.low, 4.5 - half, 0.03);
  EXPECT_NEAR(interval.high, 4.5 + half, 0.03);
}

// One run fails at everything and one at nothing: drawn in each of 100 pairs on its own, the mean of two has the
// variance 1/4 / 2 / 100.
TEST(Bootstrap, PairByPair) {
  const Interval apart = stratified_bootstrap(std::vector<std::vector<double>>(100, {0, 1}), {4000, 1});
  EXPECT_NEAR(apart.low, 0.5 - 1.96 * std::sqrt(1.0 / 800), 0.006);
  EXPECT_NEAR(apart.high, 0.5 + 1.96 * std::sqrt(1.0 / 800), 0.006);
}

TEST(Bootstrap, TheSeedDecides) {
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(std::sqrt(i));
  const auto interval = [&](uint64_t seed) { return stratified_bootstrap({values}, {500, seed}); };
  EXPECT_EQ(interval(1).low, interval(1).low);
  EXPECT_NE(interval(1).low, interval(2).low);
}

}  // namespace
}  // namespace synpo
