#include "nn/loss.h"

#include <gtest/gtest.h>

#include "helpers/numbers.h"
#include "nn/buffer.h"
#include "nn/gemm.h"

namespace synpo {
namespace {

TEST(CrossEntropy, IsFiniteDifferences) {
  std::vector<double> logits = random_values<double>(7, 1), gradient(7), unused(7);
  for (double& logit : logits) logit *= 5;
  const double loss = cross_entropy(logits.data(), 7, 3, 0.25, gradient.data());
  double sum = 0;
  for (const double logit : logits) sum += std::exp(logit);
  EXPECT_NEAR(loss, std::log(sum) - logits[3], 1e-13);  // not weighted
  for (int i = 0; i < 7; ++i)
    EXPECT_NEAR(gradient[i],
                0.25 * central_difference(logits[i], 1e-5,
                                          [&] { return cross_entropy(logits.data(), 7, 3, 1.0, unused.data()); }),
                1e-9);
}

TEST(CrossEntropy, LargeScoresDoNotOverflow) {
  const float logits[3] = {3e4f, -3e4f, 3e4f - 100};
  float gradient[3];
  EXPECT_EQ(cross_entropy(logits, 3, 0, 1.0f, gradient), 0);
  EXPECT_EQ(gradient[0], 0);
  EXPECT_EQ(cross_entropy(logits, 3, 1, 1.0f, gradient), 6e4);
  EXPECT_EQ(gradient[1], -1);
  const float equal[2] = {1e30f, 1e30f};
  EXPECT_NEAR(cross_entropy(equal, 2, 1, 1.0f, gradient), std::log(2.0), 1e-7);
}

TEST(Argmax, TiesGoToTheFirst) {
  const float values[4] = {1, 3, 3, 2};
  EXPECT_EQ(argmax(values, 4), 1);
}

}  // namespace
}  // namespace synpo
