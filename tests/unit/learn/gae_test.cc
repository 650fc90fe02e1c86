#include "learn/ppo/gae.h"

#include <gtest/gtest.h>

#include "helpers/policy_fixture.h"

namespace synpo {
namespace {

constexpr StepEnd kOn = StepEnd::kGoesOn, kEnd = StepEnd::kTerminated, kCut = StepEnd::kTruncated;

TEST(Gae, IsTheHandComputedOneWithinAnEpisode) {
  // gamma 0.5, lambda 0.5, one lane, three steps, V after the last 8.
  const float reward[] = {1, 2, 3}, value[] = {4, 2, 6}, cut[] = {0, 0, 0}, last[] = {8};
  const StepEnd end[] = {kOn, kOn, kOn};
  // delta_2 = 3 + 4 - 6 = 1; delta_1 = 2 + 3 - 2 = 3; delta_0 = 1 + 1 - 4 = -2.
  const std::vector<float> want = {-2 + 0.25f * 3.25f, 3 + 0.25f, 1};
  EXPECT_EQ(advantages({3, 1, reward, value, end, cut, last}, {0.5, 0.5}), want);
}

TEST(Gae, NothingComesFromAfterAnEnd) {
  // Two lanes side by side: one is terminated, one cut, at their second of three steps.
  const float reward[] = {1, 1, 2, 2, 3, 3}, value[] = {4, 4, 2, 2, 6, 6}, last[] = {8, 8};
  const float cut[] = {99, 99, 99, 10, 99, 99};  // read where a step is cut alone
  const StepEnd end[] = {kOn, kOn, kEnd, kCut, kOn, kOn};
  // Terminated: delta_1 = 2 - 2 = 0. Cut: delta_1 = 2 + 0.5 * 10 - 2 = 5. delta_0 = -2 and delta_2 = 1 in both.
  const std::vector<float> want = {-2, -2 + 0.25f * 5, 0, 5, 1, 1};
  EXPECT_EQ(advantages({3, 2, reward, value, end, cut, last}, {0.5, 0.5}), want);
}

TEST(Gae, WithLambdaOneTheReturnIsTheDiscountedSum) {
  const float reward[] = {1, 2, 4}, value[] = {7, -3, 5}, cut[] = {0, 0, 0}, last[] = {0};
  const StepEnd end[] = {kOn, kOn, kEnd};
  const std::vector<float> got = advantages({3, 1, reward, value, end, cut, last}, {0.5, 1});
  EXPECT_FLOAT_EQ(got[0] + value[0], 1 + 0.5f * 2 + 0.25f * 4);
}

}  // namespace
}  // namespace synpo
