#include "nn/layers/frozen_perceptron.h"

#include <gtest/gtest.h>

#include "helpers/numbers.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/norm.h"
#include "nn/layers/perceptron.h"
#include "nn/layout.h"
#include "nn/loss.h"

namespace synpo {
namespace {

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

}  // namespace
}  // namespace synpo
