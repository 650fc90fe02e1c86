#include "stats/interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace synpo {
namespace {

TEST(Wilson, HandComputed) {
  // p = 1/4, z^2/n = 1: (1/4 + 1/2 +- 2 sqrt(3/64 + 4/64)) / 2 = (3/4 +- sqrt(7)/4) / 2.
  const Interval quarter = wilson(1, 4, 2);
  EXPECT_NEAR(quarter.low, (3 - std::sqrt(7.0)) / 8, 1e-15);
  EXPECT_NEAR(quarter.high, (3 + std::sqrt(7.0)) / 8, 1e-15);
  // k = 0 gives z^2 / (n + z^2) above: 3.841458821 / 13.841458821.
  EXPECT_EQ(wilson(0, 10).low, 0);
  EXPECT_NEAR(wilson(0, 10).high, 0.2775327999, 1e-9);
  EXPECT_NEAR(wilson(10, 10).low, 1 - 0.2775327999, 1e-9);
  EXPECT_EQ(wilson(10, 10).high, 1);
  // 8 of 10, as tables have it.
  EXPECT_NEAR(wilson(8, 10).low, 0.490162, 1e-6);
  EXPECT_NEAR(wilson(8, 10).high, 0.943318, 1e-6);
  EXPECT_EQ(wilson(0, 0).low, 0);
  EXPECT_EQ(wilson(0, 0).high, 1);
}

TEST(Wilson, HoldsTheRateAndMirrors) {
  for (int64_t n : {1, 7, 100, 100000}) {
    for (int64_t k = 0; k <= n; k += std::max<int64_t>(1, n / 7)) {
      const Interval interval = wilson(k, n), mirror = wilson(n - k, n);
      EXPECT_LE(interval.low, double(k) / double(n));
      EXPECT_GE(interval.high, double(k) / double(n));
      EXPECT_LT(interval.low, interval.high);
      EXPECT_NEAR(interval.low, 1 - mirror.high, 1e-12);
    }
  }
}

// Newcombe 1998, Interval estimation for the difference between independent proportions, Table II, method 10.
TEST(Newcombe, Published) {
  const struct {
    int64_t k1, n1, k2, n2;
    double low, high;
  } cases[] = {{56, 70, 48, 80, 0.0524, 0.3339}, {9, 10, 3, 10, 0.1705, 0.8090},  {6, 7, 2, 7, 0.0582, 0.8062},
               {5, 56, 0, 29, -0.0381, 0.1926},  {0, 10, 0, 20, -0.1611, 0.2775}, {0, 10, 0, 10, -0.2775, 0.2775},
               {10, 10, 0, 20, 0.6791, 1.0000},  {10, 10, 0, 10, 0.6075, 1.0000}};
  for (const auto& c : cases) {
    const Interval interval = newcombe(c.k1, c.n1, c.k2, c.n2), mirror = newcombe(c.k2, c.n2, c.k1, c.n1);
    EXPECT_NEAR(interval.low, c.low, 5e-5) << c.k1 << " of " << c.n1;
    EXPECT_NEAR(interval.high, c.high, 5e-5) << c.k1 << " of " << c.n1;
    EXPECT_NEAR(mirror.low, -interval.high, 1e-15);
  }
}

// Newcombe 1998, Two-sided confidence intervals for the single proportion, Table I, method 3.
TEST(Wilson, Published) {
  EXPECT_NEAR(wilson(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson(15, 148).high, 0.1605, 5e-5);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson(1, 29).low, 0.0061, 5e-5);
  EXPECT_NEAR(wilson(1, 29).high, 0.1718, 5e-5);
}

// 1, 2, 3, 4, 9 and 30 degrees of freedom as tables have them; 1.5 and 501 by a program of its own.
TEST(Student, Published) {
  const std::pair<double, double> cases[] = {{1, 12.7062047}, {2, 4.30265273},   {3, 3.18244631},
                                             {4, 2.77644511}, {9, 2.26215716},   {30, 2.04227246},
                                             {1.5, 6.016663}, {501, 1.96471030}, {1e9, 1.95996398}};
  for (const auto& [df, t] : cases) EXPECT_NEAR(student95(df), t, 5e-7 * t) << df;
  const Interval interval = student(mean_sd({2, 4, 9}));  // mean 5, sd sqrt(13)
  EXPECT_NEAR(interval.low, 5 - 4.30265273 * std::sqrt(13.0 / 3), 1e-7);
  EXPECT_NEAR(interval.high, 5 + 4.30265273 * std::sqrt(13.0 / 3), 1e-7);
  EXPECT_TRUE(std::isnan(student(mean_sd({2})).low)) << "one run says nothing of others";
  EXPECT_TRUE(std::isnan(student(mean_sd({2, 2})).low)) << "nor do runs that are all alike";
}

TEST(MeanSd, DividesByOneLess) {
  const MeanSd eight = mean_sd({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(eight.count, 8);
  EXPECT_EQ(eight.mean, 5);
  EXPECT_NEAR(eight.sd, std::sqrt(32.0 / 7), 1e-15);
  EXPECT_EQ(mean_sd({3}).mean, 3);
  EXPECT_TRUE(std::isnan(mean_sd({3}).sd));
  EXPECT_TRUE(std::isnan(mean_sd({}).mean));
}

}  // namespace
}  // namespace synpo
