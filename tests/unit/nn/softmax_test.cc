#include "nn/softmax.h"

#include <gtest/gtest.h>

#include <cmath>

namespace synpo {
namespace {

TEST(Softmax, IsTheHandComputedOne) {
  const float scores[] = {1000, 1000 + std::log(3.0f), 1000};
  double p[3];
  EXPECT_NEAR(softmax(scores, 3, 1, p), 1000 + std::log(5.0), 1e-4);
  EXPECT_NEAR(p[0], 0.2, 1e-4);
  EXPECT_NEAR(p[1], 0.6, 1e-4);
  softmax(scores, 3, 0.5, p);  // 1 : 9 : 1
  EXPECT_NEAR(p[1], 9.0 / 11, 1e-4);
  EXPECT_DOUBLE_EQ(p[0] + p[1] + p[2], 1);
}

TEST(Softmax, DrawsGoByTheSumsOfP) {
  const double p[] = {0.25, 0, 0.5, 0.25};
  EXPECT_EQ(draw(p, 4, 0), 0);
  EXPECT_EQ(draw(p, 4, 0.249), 0);
  EXPECT_EQ(draw(p, 4, 0.25), 2);
  EXPECT_EQ(draw(p, 4, 0.749), 2);
  EXPECT_EQ(draw(p, 4, 0.75), 3);
  const double rounded[] = {0.5, 0.49};
  EXPECT_EQ(draw(rounded, 2, 0.999), 1);
}

}  // namespace
}  // namespace synpo
