#include "stats/chance.h"

#include <gtest/gtest.h>

#include "stats/report/margins.h"

namespace synpo {
namespace {

// Enumerated by a program of its own, over all pairs of counts.
TEST(Newcombe, HowOftenItLeavesOutZeroByChance) {
  const struct {
    double rate;
    int64_t n1, n2;
    double often;
  } cases[] = {{0.9, 10, 10, 0.0090402222},
               {0.95, 20, 20, 0.0020950655},
               {0.98, 100, 100, 0.0157867752},
               {0.5, 4, 4, 0.0703125},
               {0.95, 3, 200, 0.1019794283},
               {0.9, 100, 50, 0.0415556634},
               {0.995, 1000, 1000, 0.039406195},
               {0.5, 4, 40000, 0.1249965892},
               {0.5, 10000, 10000, 0.0501468836},
               {1, 5, 5, 0},
               {0, 5, 5, 0}};
  for (const auto& c : cases) {
    EXPECT_NEAR(newcombe_false_alarms(c.rate, c.n1, c.n2), c.often, 1e-8) << c.rate << ' ' << c.n1;
    EXPECT_NEAR(newcombe_false_alarms(1 - c.rate, c.n2, c.n1), c.often, 1e-8) << c.rate << ' ' << c.n1;
  }
  EXPECT_NEAR(newcombe_false_alarms(0.5, 50000, 50000), 0.05, 0.001);
  EXPECT_NEAR(newcombe_false_alarms(0.5, 4, 4000000000000), 0.125, 0.001) << "of 16 outcomes the two ends";
}

}  // namespace
}  // namespace synpo
