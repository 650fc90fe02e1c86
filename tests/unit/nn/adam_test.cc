#include "nn/adam.h"

#include <gtest/gtest.h>

#include "helpers/numbers.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/norm.h"
#include "nn/loss.h"

namespace synpo {
namespace {

TEST(Adam, TwoStepsByHand) {
  Parallel parallel(1);
  const AdamOptions options = {0.1, 0.9, 0.999, 1e-8, 0.5};
  double parameter = 2, m = 0, v = 0, average = 1;
  double gradient = 3;
  adam_step(parallel, options, 1, 1, &gradient, &parameter, &m, &v, &average, 0.75);
  // g = 3 + 0.5 * 2 = 4; both corrected moments are g and g^2, so that the step is the learning rate.
  EXPECT_NEAR(m, 0.4, 1e-15);
  EXPECT_NEAR(v, 0.016, 1e-15);
  EXPECT_NEAR(parameter, 1.9, 1e-9);
  EXPECT_NEAR(average, 0.75 * 1 + 0.25 * 1.9, 1e-9);
  gradient = -2.95;
  adam_step(parallel, options, 2, 1, &gradient, &parameter, &m, &v);
  // g = -2.95 + 0.5 * 1.9 = -2; m = 0.16, corrected by 1 - 0.81; v = 0.019984, corrected by 1 - 0.998001.
  EXPECT_NEAR(m, 0.16, 1e-9);
  EXPECT_NEAR(v, 0.019984, 1e-9);
  EXPECT_NEAR(parameter, 1.9 - 0.1 * (0.16 / 0.19) / std::sqrt(0.019984 / 0.001999), 1e-8);
}

TEST(Adam, EveryParameterMovesByItself) {
  // More values than one shard takes.
  constexpr size_t kCount = 150001;
  const AdamOptions options = {0.01, 0.9, 0.99, 1e-8, 0.1};
  const std::vector<float> gradient = random_values<float>(kCount, 1), start = random_values<float>(kCount, 2);
  std::vector<float> results[2];
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    std::vector<float> parameter = start, m(kCount, 0), v(kCount, 0), average = start;
    for (int step = 1; step <= 3; ++step)
      adam_step(parallel, options, step, kCount, gradient.data(), parameter.data(), m.data(), v.data(), average.data(),
                0.5);
    for (size_t i = 0; i < kCount; i += 997) {
      double p = start[i], first = 0, second = 0, mean = start[i];
      for (int step = 1; step <= 3; ++step) {
        const double g = gradient[i] + 0.1 * p;
        first = 0.9 * first + 0.1 * g;
        second = 0.99 * second + 0.01 * g * g;
        p -= 0.01 * (first / (1 - std::pow(0.9, step))) / (std::sqrt(second / (1 - std::pow(0.99, step))) + 1e-8);
        mean = 0.5 * mean + 0.5 * p;
      }
      ASSERT_NEAR(parameter[i], p, 2e-6);
      ASSERT_NEAR(average[i], mean, 2e-6);
    }
    results[threads - 1] = parameter;
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace synpo
