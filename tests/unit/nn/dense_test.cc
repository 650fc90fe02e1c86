#include "nn/layers/dense.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "helpers/numbers.h"
#include "helpers/targets.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/frozen_perceptron.h"
#include "nn/layers/perceptron.h"
#include "nn/loss.h"

namespace synpo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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
    for (const int threads : {1, 2, 16}) {
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

}  // namespace
}  // namespace synpo
