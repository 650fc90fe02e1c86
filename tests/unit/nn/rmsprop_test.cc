#include "nn/rmsprop.h"

#include <gtest/gtest.h>

#include <cmath>

#include "helpers/numbers.h"
#include "helpers/policy_fixture.h"
#include "learn/ppo/ppo.h"

namespace synpo {
namespace {

TEST(RmsProp, IsTheHandComputedStep) {
  Parallel parallel(1);
  const double gradient[] = {6, -2};
  double parameter[] = {2, 0.5}, v[] = {0, 4};
  rmsprop_step(parallel, {0.1, 0.75, 0.5, 0.5}, 2, 0.5, gradient, parameter, v);
  // g = 0.5 * 6 + 0.5 * 2 = 4, v = 0.25 * 16 = 4; g = -1 + 0.25 = -0.75, v = 0.75 * 4 + 0.25 * 0.5625 = 3.140625.
  EXPECT_DOUBLE_EQ(v[0], 4);
  EXPECT_DOUBLE_EQ(parameter[0], 2 - 0.1 * 4 / 2.5);
  EXPECT_DOUBLE_EQ(v[1], 3.140625);
  EXPECT_DOUBLE_EQ(parameter[1], 0.5 + 0.1 * 0.75 / (std::sqrt(3.140625) + 0.5));
}

TEST(RmsProp, LengthsAndClippingDoNotDependOnThreads) {
  const std::vector<float> values = random_values<float>(200000, 3);
  Parallel one(1), two(2);
  EXPECT_EQ(sum_of_squares(one, values.size(), values.data()), sum_of_squares(two, values.size(), values.data()));
  EXPECT_NEAR(sum_of_squares(one, values.size(), values.data()), inner_product(values, values), 1e-6);
  EXPECT_EQ(clip_factor(0.4, 0.5), 1);
  EXPECT_EQ(clip_factor(2, 0.5), 0.25);
}

}  // namespace
}  // namespace synpo
