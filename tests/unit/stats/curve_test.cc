#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "stats/curve.h"

namespace synpo {
namespace {

TEST(MeanCurve, OverRunsOnDifferentGrids) {
  const Curve a = {{0, 10, 20}, {0, 1, 0}}, b = {{5, 15, 40}, {0.5, 0.5, 3}};
  const MeanCurve mean = mean_curve({a, b}, Band::kSd);
  // Where both have values: from b's first x to a's last.
  EXPECT_EQ(mean.x, (std::vector<double>{5, 10, 15, 20}));
  EXPECT_EQ(mean.runs, 2);
  EXPECT_EQ(mean.longest, 40);
  const double expected[] = {0.5, 0.75, 0.5, (0 + 1.0) / 2};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(mean.mean[i], expected[i], 1e-12) << i;
  // 1 and 0.5 at x = 10: the sd with divisor 1 is 0.5 / sqrt 2.
  EXPECT_NEAR(mean.high[1] - mean.mean[1], 0.5 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(mean.mean[1] - mean.low[1], 0.5 / std::sqrt(2.0), 1e-12);
  const MeanCurve range = mean_curve({a, b}, Band::kRange);
  EXPECT_EQ(range.low[1], 0.5);
  EXPECT_EQ(range.high[1], 1);
}

TEST(MeanCurve, OneRunIsItselfAndHasNoBand) {
  const MeanCurve mean = mean_curve({{{1, 2, 4}, {5, 6, 7}}}, Band::kSd);
  EXPECT_EQ(mean.x, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(mean.mean, (std::vector<double>{5, 6, 7}));
  EXPECT_TRUE(mean.low.empty());
  EXPECT_TRUE(mean_curve({{{1}, {5}}, {{1}, {6}}}, Band::kNone).low.empty());
  EXPECT_THROW(mean_curve({{{1, 2}, {0, 0}}, {{3, 4}, {0, 0}}}, Band::kSd), Error);
}

// Two runs at 90 and 100 have the sd 7.07: the band ends where no rate is.
TEST(MeanCurve, BandsStayWithinTheirBounds) {
  const std::vector<Curve> runs = {{{1, 2}, {100, 0}}, {{1, 2}, {90, 10}}};
  const MeanCurve free = mean_curve(runs, Band::kSd), bound = mean_curve(runs, Band::kSd, {0, 100});
  EXPECT_NEAR(free.high[0], 95 + std::sqrt(50.0), 1e-12);
  EXPECT_NEAR(free.low[1], 5 - std::sqrt(50.0), 1e-12);
  EXPECT_EQ(bound.high[0], 100);
  EXPECT_NEAR(bound.low[0], 95 - std::sqrt(50.0), 1e-12);
  EXPECT_EQ(bound.low[1], 0);
  EXPECT_EQ(bound.mean, free.mean);
}

TEST(Curve, ARunningMeanIsOfTheLastPoints) {
  const Curve curve = {{1, 2, 3, 4}, {8, 4, 0, 2}};
  EXPECT_EQ(running_mean(curve, 1).y, curve.y);
  EXPECT_EQ(running_mean(curve, 2).y, (std::vector<double>{8, 6, 2, 1}));
  EXPECT_EQ(running_mean(curve, 100).y, (std::vector<double>{8, 6, 4, 3.5}));
  EXPECT_EQ(running_mean(curve, 3).x, curve.x);
}

}  // namespace
}  // namespace synpo
