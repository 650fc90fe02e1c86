#include "nn/layers/norm.h"

#include <gtest/gtest.h>

#include <limits>

#include "helpers/numbers.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/frozen_perceptron.h"
#include "nn/layers/perceptron.h"
#include "nn/loss.h"

namespace synpo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Rows [rows, channels] through a BatchNorm in three shards of different size.
struct NormRun {
  static constexpr int kShards = 3;
  NormRun(size_t row_count, int channel_count)
      : rows(row_count), channels(channel_count), norm(channels), size(rows * channels) {
    z = random_values<double>(size, 1);
    for (size_t i = 0; i < size; ++i) z[i] = z[i] * (1 + i % channels) + i % channels;
    gamma = random_values<double>(channels, 2);
    beta = random_values<double>(channels, 3);
    running_mean = random_values<double>(channels, 4);
    running_variance.assign(channels, 2);
  }
  size_t begin(int shard) const { return shard == 0 ? 0 : shard == 1 ? rows / 5 : shard == 2 ? rows / 2 : rows; }
  std::vector<double> forward() {
    std::vector<double> mean = running_mean, variance = running_variance;
    norm.begin(kShards);
    for (int shard = kShards; shard-- > 0;)
      norm.add_rows(shard, z.data() + begin(shard) * channels, begin(shard + 1) - begin(shard), mean.data());
    norm.finish(rows, gamma.data(), beta.data(), mean.data(), variance.data());
    mean_after = mean;
    variance_after = variance;
    std::vector<double> y(size);
    for (size_t i = 0; i < size; ++i) y[i] = z[i] * norm.scale()[i % channels] + norm.shift()[i % channels];
    return y;
  }
  size_t rows;
  int channels;
  BatchNorm<double> norm;
  size_t size;
  std::vector<double> z, gamma, beta, running_mean, running_variance, mean_after, variance_after;
};

TEST(BatchNorm, ForwardIsTheDefinition) {
  NormRun run(150, 19);
  const std::vector<double> y = run.forward();
  for (int c = 0; c < run.channels; ++c) {
    double mean = 0, variance = 0;
    for (size_t r = 0; r < run.rows; ++r) mean += run.z[r * run.channels + c] / run.rows;
    for (size_t r = 0; r < run.rows; ++r) variance += std::pow(run.z[r * run.channels + c] - mean, 2) / run.rows;
    for (size_t r = 0; r < run.rows; ++r)
      ASSERT_NEAR(y[r * run.channels + c],
                  (run.z[r * run.channels + c] - mean) / std::sqrt(variance + 1e-5) * run.gamma[c] + run.beta[c],
                  1e-12);
    EXPECT_NEAR(run.mean_after[c], 0.9 * run.running_mean[c] + 0.1 * mean, 1e-12);
    EXPECT_NEAR(run.variance_after[c], 0.9 * 2 + 0.1 * variance * 150 / 149, 1e-11);
  }
}

TEST(BatchNorm, BackwardIsFiniteDifferences) {
  for (const int channels : {5, 8, 19}) {
    NormRun run(100, channels);
    const std::vector<double> d = random_values<double>(run.size, 9);
    const auto loss = [&] { return inner_product(run.forward(), d); };
    run.forward();
    run.norm.begin_backward(NormRun::kShards);
    for (int shard = 0; shard < NormRun::kShards; ++shard) {
      const size_t at = run.begin(shard) * channels;
      run.norm.add_backward_rows(shard, d.data() + at, run.z.data() + at, run.begin(shard + 1) - run.begin(shard),
                                 false);
    }
    std::vector<double> dgamma(channels, kNan), dbeta(channels, kNan), dz = d;
    run.norm.finish_backward(run.rows, run.gamma.data(), dgamma.data(), dbeta.data());
    run.norm.apply_backward(dz.data(), run.z.data(), dz.data(), run.rows, false);
    for (size_t i = 0; i < run.size; i += 7) ASSERT_NEAR(dz[i], central_difference(run.z[i], 1e-5, loss), 1e-7);
    for (int c = 0; c < channels; ++c) {
      ASSERT_NEAR(dgamma[c], central_difference(run.gamma[c], 1e-3, loss), 1e-8);
      ASSERT_NEAR(dbeta[c], central_difference(run.beta[c], 1e-3, loss), 1e-8);
    }
  }
}

TEST(BatchNorm, SquaresDoNotCancel) {
  // A mean a thousand times the deviation, in float, with a running mean that knows it.
  constexpr int kRows = 4096;
  std::vector<float> z(kRows);
  double sum = 0;
  for (int i = 0; i < kRows; ++i) sum += z[i] = 1000 + float(i % 16) / 16;
  float gamma = 1, beta = 0, mean = 1000, variance = 0;
  BatchNorm<float> norm(1);
  norm.begin(1);
  norm.add_rows(0, z.data(), kRows, &mean);
  norm.finish(kRows, &gamma, &beta, &mean, &variance);
  EXPECT_NEAR(norm.mean()[0], sum / kRows, 1e-4);
  EXPECT_NEAR(norm.inverse_sd()[0], 1 / std::sqrt((16 * 16 - 1) / 12.0 / 256 + 1e-5), 1e-4);
}

TEST(BatchNorm, BackwardThroughTheReLUAfterIt) {
  // masked: as if d had been set to zero where the normalised value is not positive.
  NormRun run(100, 19);
  const std::vector<double> y = run.forward(), d = random_values<double>(run.size, 9);
  std::vector<double> zeroed = d, dz[2] = {std::vector<double>(run.size), std::vector<double>(run.size)};
  for (size_t i = 0; i < run.size; ++i)
    if (y[i] <= 0) zeroed[i] = 0;
  for (const bool masked : {false, true}) {
    const std::vector<double>& from = masked ? d : zeroed;
    std::vector<double> dgamma(run.channels), dbeta(run.channels);
    run.norm.begin_backward(1);
    run.norm.add_backward_rows(0, from.data(), run.z.data(), run.rows, masked);
    run.norm.finish_backward(run.rows, run.gamma.data(), dgamma.data(), dbeta.data());
    run.norm.apply_backward(from.data(), run.z.data(), dz[masked].data(), run.rows, masked);
  }
  EXPECT_EQ(dz[0], dz[1]);
}

TEST(Norm, Frozen) {
  constexpr int kChannels = 21;
  const std::vector<double> gamma = random_values<double>(kChannels, 3), beta = random_values<double>(kChannels, 4),
                            mean = random_values<double>(kChannels, 5), z = random_values<double>(kChannels, 7);
  std::vector<double> variance = random_values<double>(kChannels, 6), scale(kChannels), shift(kChannels);
  for (double& v : variance) v = std::abs(v);
  frozen_norm(kChannels, gamma.data(), beta.data(), mean.data(), variance.data(), scale.data(), shift.data());
  for (int c = 0; c < kChannels; ++c)
    ASSERT_NEAR(z[c] * scale[c] + shift[c], (z[c] - mean[c]) / std::sqrt(variance[c] + 1e-5) * gamma[c] + beta[c],
                1e-13);
}

}  // namespace
}  // namespace synpo
