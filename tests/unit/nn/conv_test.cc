#include "nn/layers/conv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>

#include "helpers/numbers.h"
#include "helpers/targets.h"
#include "kernel/bilinear.h"

namespace synpo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct ConvShape {
  const char* form;
  int side, in, out, kernel, stride, samples;
};

constexpr ConvShape kConvShapes[] = {
    {"Winograd, four tiles", 8, 5, 7, 3, 1, 3},
    {"Winograd, whole vectors", 8, 16, 32, 3, 1, 2},
    {"Winograd, one tile", 4, 17, 19, 3, 1, 3},
    {"Toeplitz", 2, 9, 5, 3, 1, 4},
    {"Toeplitz, whole vectors and a rest", 2, 35, 33, 3, 1, 3},
    {"strided 3x3 at 16", 16, 3, 5, 3, 2, 2},
    {"strided 3x3 at 8", 8, 7, 18, 3, 2, 3},
    {"strided 3x3 at 4", 4, 5, 3, 3, 2, 3},
    {"1x1", 2, 11, 6, 1, 1, 3},
    {"strided 1x1 at 16", 16, 3, 5, 1, 2, 2},
    {"strided 1x1 at 4", 4, 6, 17, 1, 2, 3},
    // Weights that are no smaller than what their gradients are made of, which is kept then.
    {"Toeplitz, large weight", 2, 70, 80, 3, 1, 3},
    {"strided 3x3, large weight", 4, 40, 512, 3, 2, 1},
    {"1x1, large weight", 2, 280, 260, 1, 1, 2},
};

// By how much a transformed form magnifies what rounding every factor leaves of an output, beside what it is in the
// direct form: for random inputs and weights, in the root of mean squares, y = Out ((Weight w) * (In x)) along rows and
// columns. The gradients' forms have the same.
template <class Form>
double magnification() {
  constexpr auto& weight = Form::kWeight;
  const auto square = [](double value) { return value * value; };
  double noise = 0, signal = 0;
  for (int out = 0; out < Form::kOut; ++out) {
    double of_output[Form::kIn][3] = {};
    for (int p = 0; p < Form::kProducts; ++p) {
      double inputs = 0, taps = 0;
      for (int i = 0; i < Form::kIn; ++i) inputs += square(Form::kInput.at[p][i]);
      for (int t = 0; t < 3; ++t) taps += square(weight.at[p][t]);
      noise += square(Form::kOutput.at[out][p]) * inputs * taps;
      for (int i = 0; i < Form::kIn; ++i)
        for (int t = 0; t < 3; ++t)
          of_output[i][t] += Form::kOutput.at[out][p] * Form::kInput.at[p][i] * weight.at[p][t];
    }
    for (const auto& of_input : of_output)
      for (const double factor : of_input) signal += square(factor);
  }
  return noise / signal;  // its root, for rows and for columns
}

// What a transformed form may differ from the direct one by. Below 1e-3 the targets' bounds leave room for it.
double form_error(const ConvShape& s) {
  const double rounding = kernels<float>().product_error;
  if (rounding < 1e-3 || s.kernel != 3 || s.stride != 1) return std::max(2e-6, rounding);
  return rounding * (s.side == 2 ? magnification<Toeplitz2>() : magnification<Winograd43>());
}

// From the definition.
std::vector<double> convolved(const ConvShape& s, const std::vector<double>& x, const std::vector<double>& w) {
  const int side_out = (s.side + s.stride - 1) / s.stride, padding = s.kernel / 2;
  std::vector<double> y(size_t(s.samples) * side_out * side_out * s.out, 0);
  for (int n = 0; n < s.samples; ++n)
    for (int i = 0; i < side_out; ++i)
      for (int j = 0; j < side_out; ++j)
        for (int ki = 0; ki < s.kernel; ++ki)
          for (int kj = 0; kj < s.kernel; ++kj) {
            const int r = i * s.stride + ki - padding, q = j * s.stride + kj - padding;
            if (r < 0 || q < 0 || r >= s.side || q >= s.side) continue;
            for (int a = 0; a < s.in; ++a)
              for (int b = 0; b < s.out; ++b)
                y[((size_t(n) * side_out + i) * side_out + j) * s.out + b] +=
                    x[((size_t(n) * s.side + r) * s.side + q) * s.in + a] *
                    w[((size_t(ki) * s.kernel + kj) * s.in + a) * s.out + b];
          }
  return y;
}

template <class T>
struct ConvResult {
  std::vector<T> y, dx, dw;
};

// All of the backward pass, as the network does it: slab by slab, unit by unit.
template <class T>
void backward(Parallel& parallel, const Conv<T>& conv, int samples, const std::vector<T>& x, const std::vector<T>& dy,
              T* dx, bool add_dx, std::vector<T>& dw) {
  typename Conv<T>::Slab slab;
  std::vector<Buffer<T>> scratch(parallel.threads());
  std::vector<T> dfactors(conv.dfactors_size(), T(kNan));
  conv.reserve(slab, conv.kSlab);
  for (int begin = 0; begin < samples; begin += conv.kSlab) {
    const int size = std::min(samples - begin, conv.kSlab);
    parallel.run(shard_count(size, conv.unit()), [&](int shard, int thread) {
      const Range part = shard_range(size, conv.unit(), shard);
      const size_t at = begin + part.begin;
      conv.backward(slab, part, x.data() + at * conv.x_size(), dy.data() + at * conv.y_size(),
                    dx ? dx + at * conv.x_size() : nullptr, add_dx, scratch[thread]);
    });
    parallel.run(conv.pack_shards(false), [&](int p, int) { conv.pack_outputs(p, slab, size); });
    parallel.run(conv.gradient_shards(false),
                 [&](int shard, int) { conv.weight_gradient(shard, false, slab, size, begin > 0, dfactors.data()); });
  }
  if (conv.transformed())
    for (int tap = 0; tap < conv.kTaps; ++tap) conv.finish_gradient(tap, dfactors.data(), dw.data());
  else
    dw = dfactors;
}

// Forward in two calls, backward with dx added to what is there where asked.
template <class T>
ConvResult<T> run_conv(const ConvShape& s, typename Conv<T>::Method method, const std::vector<T>& x,
                       const std::vector<T>& w, const std::vector<T>& dy, int threads, bool add_dx, T there) {
  Parallel parallel(threads);
  Conv<T> conv(s.side, s.in, s.out, s.kernel, s.stride, method);
  EXPECT_EQ(conv.weight_size(), w.size());
  EXPECT_EQ(conv.x_size() * s.samples, x.size());
  EXPECT_EQ(conv.y_size() * s.samples, dy.size());
  for (int p = 0; p < conv.products(); ++p) conv.prepare(p, w.data(), true);
  ConvResult<T> result = {std::vector<T>(dy.size(), T(kNan)), std::vector<T>(x.size(), add_dx ? there : T(kNan)),
                          std::vector<T>(w.size(), T(kNan))};
  Buffer<T> scratch;
  const int first = s.samples / 2;
  conv.forward(first, x.data(), result.y.data(), scratch);
  conv.forward(s.samples - first, x.data() + first * conv.x_size(), result.y.data() + first * conv.y_size(), scratch);
  backward(parallel, conv, s.samples, x, dy, result.dx.data(), add_dx, result.dw);
  return result;
}

class ConvForms : public testing::TestWithParam<ConvShape> {
 protected:
  ConvForms() : s(GetParam()) {
    const int side_out = (s.side + s.stride - 1) / s.stride;
    x = random_values<double>(size_t(s.samples) * s.side * s.side * s.in, 1);
    w = random_values<double>(size_t(s.kernel) * s.kernel * s.in * s.out, 2);
    dy = random_values<double>(size_t(s.samples) * side_out * side_out * s.out, 3);
  }
  ConvShape s;
  std::vector<double> x, w, dy;
};

TEST_P(ConvForms, ForwardIsTheDefinition) {
  for_every_target([&](const std::string&) {
    for (const auto method : {Conv<double>::Method::kFastest, Conv<double>::Method::kDirect})
      EXPECT_LT(relative_error(run_conv<double>(s, method, x, w, dy, 1, false, 0).y, convolved(s, x, w)), 1e-13);
  });
}

TEST_P(ConvForms, BackwardIsFiniteDifferences) {
  // The convolution is linear in x and in w, so that a step of 1 has no error but rounding.
  const auto loss = [&] { return inner_product(convolved(s, x, w), dy); };
  const std::vector<double> fixed_x = x, fixed_w = w;
  for (const bool add_dx : {false, true}) {
    const ConvResult<double> got =
        run_conv<double>(s, Conv<double>::Method::kFastest, fixed_x, fixed_w, dy, 2, add_dx, 0.5);
    Random random(1, Purpose::kInit, 6);
    for (int i = 0; i < 60; ++i) {
      const size_t at_x = random.below(uint32_t(x.size())), at_w = random.below(uint32_t(w.size()));
      ASSERT_NEAR(got.dx[at_x], central_difference(x[at_x], 1, loss) + (add_dx ? 0.5 : 0), 1e-10);
      ASSERT_NEAR(got.dw[at_w], central_difference(w[at_w], 1, loss), 1e-10);
    }
  }
}

TEST_P(ConvForms, FastestIsDirectInFloat) {
  const std::vector<float> xf(x.begin(), x.end()), wf(w.begin(), w.end()), dyf(dy.begin(), dy.end());
  for_every_target([&](const std::string&) {
    const ConvResult<float> fast = run_conv<float>(s, Conv<float>::Method::kFastest, xf, wf, dyf, 1, false, 0);
    const ConvResult<float> direct = run_conv<float>(s, Conv<float>::Method::kDirect, xf, wf, dyf, 1, false, 0);
    const double near = form_error(s);
    EXPECT_LT(relative_error(fast.y, direct.y), near);
    EXPECT_LT(relative_error(fast.dx, direct.dx), near);
    EXPECT_LT(relative_error(fast.dw, direct.dw), near);
  });
}

TEST_P(ConvForms, DxMayBeLeftOut) {
  Parallel parallel(1);
  Conv<double> conv(s.side, s.in, s.out, s.kernel, s.stride);
  for (int p = 0; p < conv.products(); ++p) conv.prepare(p, w.data(), true);
  std::vector<double> dw(w.size(), kNan);
  backward<double>(parallel, conv, s.samples, x, dy, nullptr, false, dw);
  EXPECT_LT(relative_error(dw, run_conv<double>(s, Conv<double>::Method::kFastest, x, w, dy, 1, false, 0).dw), 1e-14);
}

std::string form_name(const testing::TestParamInfo<ConvShape>& info) {
  std::string name;
  for (const char c : std::string(info.param.form))
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name;
}
INSTANTIATE_TEST_SUITE_P(Conv, ConvForms, testing::ValuesIn(kConvShapes), form_name);

TEST(Conv, LargeBatchesOnOneAndTwoThreads) {
  // More samples than are transformed at once, and no multiple of any unit; small weights and large ones.
  for (const ConvShape& s :
       {ConvShape{"", 2, 5, 6, 3, 1, 1043}, ConvShape{"", 4, 3, 4, 3, 1, 1043}, ConvShape{"", 4, 5, 3, 3, 2, 1043},
        ConvShape{"", 2, 70, 80, 3, 1, 1043}, ConvShape{"", 4, 66, 66, 3, 1, 1043}}) {
    const int side_out = (s.side + s.stride - 1) / s.stride;
    const std::vector<float> x = random_values<float>(size_t(s.samples) * s.side * s.side * s.in, 1),
                             w = random_values<float>(9 * size_t(s.in) * s.out, 2),
                             dy = random_values<float>(size_t(s.samples) * side_out * side_out * s.out, 3);
    const ConvResult<float> one = run_conv<float>(s, Conv<float>::Method::kFastest, x, w, dy, 1, true, 0.25f);
    const ConvResult<float> two = run_conv<float>(s, Conv<float>::Method::kFastest, x, w, dy, 2, true, 0.25f);
    EXPECT_EQ(one.y, two.y);
    EXPECT_EQ(one.dx, two.dx);
    EXPECT_EQ(one.dw, two.dw);
    const ConvResult<float> direct = run_conv<float>(s, Conv<float>::Method::kDirect, x, w, dy, 1, true, 0.25f);
    const double coarse = kernels<float>().product_error;
    EXPECT_LT(relative_error(one.y, direct.y), std::max(3e-6, coarse));
    EXPECT_LT(relative_error(one.dx, direct.dx), std::max(3e-6, coarse));
    EXPECT_LT(relative_error(one.dw, direct.dw), std::max(1e-5, coarse));
  }
}

}  // namespace
}  // namespace synpo
