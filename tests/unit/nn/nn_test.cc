#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "helpers/numbers.h"
#include "helpers/targets.h"
#include "nn/adam.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/dense.h"
#include "nn/layers/frozen_perceptron.h"
#include "nn/layers/norm.h"
#include "nn/layers/perceptron.h"
#include "nn/layout.h"
#include "nn/loss.h"
#include "nn/softmax.h"

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

TEST(BatchNorm, BackwardThroughTheReLUBehindIt) {
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

struct DenseRun {
  int rows = 70, in = 21, out = 18;
  bool relu = true;
  std::vector<double> x = random_values<double>(size_t(rows) * in, 1), w = random_values<double>(size_t(in) * out, 2),
                      b = random_values<double>(out, 3);
  Parallel parallel{2};
  std::vector<double> forward() {
    std::vector<double> y(size_t(rows) * out, kNan);
    dense_forward(parallel, rows, in, out, x.data(), w.data(), b.data(), relu, y.data());
    return y;
  }
};

TEST(Dense, ForwardIsTheDefinition) {
  DenseRun run;
  for (const bool relu : {false, true}) {
    run.relu = relu;
    const std::vector<double> y = run.forward();
    for (int r = 0; r < run.rows; ++r)
      for (int c = 0; c < run.out; ++c) {
        double sum = run.b[c];
        for (int i = 0; i < run.in; ++i) sum += run.x[size_t(r) * run.in + i] * run.w[size_t(i) * run.out + c];
        ASSERT_NEAR(y[size_t(r) * run.out + c], relu ? std::max(0.0, sum) : sum, 1e-13);
      }
  }
  std::vector<double> without(size_t(run.rows) * run.out);
  dense_forward<double>(run.parallel, run.rows, run.in, run.out, run.x.data(), run.w.data(), nullptr, false,
                        without.data());
  run.relu = false;
  EXPECT_NEAR(without[1] + run.b[1], run.forward()[1], 1e-13);
}

TEST(Dense, BackwardIsFiniteDifferences) {
  DenseRun run;
  // A step moves a sum by 1e-7 at most: no ReLU may be nearer to its kink than that.
  run.relu = false;
  for (const double sum : run.forward()) ASSERT_GT(std::abs(sum), 1e-6);
  const std::vector<double> dy = random_values<double>(size_t(run.rows) * run.out, 4);
  const auto loss = [&] { return inner_product(run.forward(), dy); };
  for (const bool relu : {false, true})
    for (const bool add_dx : {false, true}) {
      run.relu = relu;
      const std::vector<double> y = run.forward();
      std::vector<double> d = dy, dx(run.x.size(), add_dx ? 1 : kNan), dw(run.w.size(), 2), db(run.out, 3);
      dense_backward(run.parallel, run.rows, run.in, run.out, run.x.data(), run.w.data(), relu ? y.data() : nullptr,
                     d.data(), dx.data(), add_dx, dw.data(), db.data());
      for (size_t i = 0; i < dx.size(); i += 11)
        ASSERT_NEAR(dx[i], central_difference(run.x[i], 1e-7, loss) + (add_dx ? 1 : 0), 1e-6);
      for (size_t i = 0; i < dw.size(); i += 5) ASSERT_NEAR(dw[i], central_difference(run.w[i], 1e-7, loss) + 2, 1e-6);
      for (size_t i = 0; i < db.size(); ++i) ASSERT_NEAR(db[i], central_difference(run.b[i], 1e-7, loss) + 3, 1e-6);
    }
}

// Large layers are packed and cut otherwise than small ones, which must not show.
TEST(Dense, ALargeLayersBitsAreThoseOfItsProducts) {
  constexpr int kRows = 515, kIn = 1030, kOut = 1040;
  const std::vector<float> x = random_values<float>(kRows * kIn, 1), w = random_values<float>(kIn * kOut, 2),
                           dy = random_values<float>(kRows * kOut, 3);
  const auto product = [](Op op_a, Op op_b, int m, int n, int k, const std::vector<float>& a, int lda,
                          const std::vector<float>& b, int ldb, float before) {
    std::vector<float> c(size_t(m) * n, before);
    gemm(op_a, op_b, m, n, k, a.data(), lda, b.data(), ldb, c.data(), n, true);
    return c;
  };
  for_every_target([&](const std::string&) {
    const std::vector<float> want_y = product(Op::kAsIs, Op::kAsIs, kRows, kOut, kIn, x, kIn, w, kOut, 0);
    const std::vector<float> want_dx = product(Op::kAsIs, Op::kTransposed, kRows, kIn, kOut, dy, kOut, w, kOut, 2);
    const std::vector<float> want_dw = product(Op::kTransposed, Op::kAsIs, kIn, kOut, kRows, x, kIn, dy, kOut, 3);
    for (const int threads : {1, 2}) {
      Parallel parallel(threads);
      std::vector<float> y(kRows * kOut), d = dy, dx(kRows * kIn, 2), dw(kIn * kOut, 3);
      dense_forward<float>(parallel, kRows, kIn, kOut, x.data(), w.data(), nullptr, false, y.data());
      dense_backward<float>(parallel, kRows, kIn, kOut, x.data(), w.data(), nullptr, d.data(), dx.data(), true,
                            dw.data(), nullptr);
      EXPECT_TRUE(y == want_y) << threads;
      EXPECT_TRUE(dx == want_dx) << threads;
      EXPECT_TRUE(dw == want_dw) << threads;
    }
  });
}

TEST(FrozenPerceptron, IsThePerceptron) {
  constexpr int kRows = 5, kIn = 3, kHidden = 7, kOut = 4;
  Parallel parallel(1);
  Layout layout;
  layout.add("before", {20});
  Perceptron<double> moving("p", kIn, kHidden, kOut, layout);
  const std::vector<double> parameters = random_values<double>(layout.total(), 1),
                            x = random_values<double>(kRows * kIn, 2);
  const FrozenPerceptron<double> frozen(moving.place(), parameters.data());
  ASSERT_EQ(frozen.in(), kIn);
  ASSERT_EQ(frozen.hidden(), kHidden);
  ASSERT_EQ(frozen.out(), kOut);
  std::vector<double> h(kRows * kHidden), y(kRows * kOut), dh(h.size()), gradient(layout.total(), 0),
      dy = random_values<double>(y.size(), 3);
  frozen.forward(kRows, x.data(), h.data(), y.data());
  const double* want = moving.forward(parallel, kRows, x.data(), parameters.data());
  EXPECT_LT(relative_error(y.data(), want, y.size()), 1e-14);
  for (const bool add : {false, true}) {
    std::vector<double> dx(x.size(), 1), want_dx(x.size(), 1);
    frozen.backward(kRows, h.data(), dy.data(), dh.data(), dx.data(), add);
    moving.backward(parallel, x.data(), dy.data(), want_dx.data(), add, parameters.data(), gradient.data());
    EXPECT_LT(relative_error(dx, want_dx), 1e-14) << add;
  }
}

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

TEST(Layout, TensorsAreAlignedAndApart) {
  Layout layout;
  EXPECT_EQ(layout.add("a", {3, 5}), 0u);
  EXPECT_EQ(layout.add("b", {17}), 16u);
  EXPECT_EQ(layout.add("c", {}), 48u);
  EXPECT_EQ(layout.total(), 64u);
  EXPECT_EQ(layout.find("b")->size, 17u);
  EXPECT_EQ(layout.find("d"), nullptr);
}

TEST(Buffer, GrowsAndMoves) {
  Buffer<float> buffer(10);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(buffer.data()) % 64, 0u);
  float* const data = buffer.data();
  EXPECT_EQ(buffer.grow(5), data);
  EXPECT_EQ(buffer.size(), 10u);
  buffer[9] = 4;
  Buffer<float> other = std::move(buffer);
  EXPECT_EQ(other[9], 4);
  other.zero();
  EXPECT_EQ(other[9], 0);
  other.grow(100000);
  EXPECT_EQ(other.size(), 100000u);
}

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
