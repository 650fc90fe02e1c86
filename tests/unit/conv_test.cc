#include "nn/conv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <tuple>

#include "nn/gemm.h"
#include "nn/lanes.h"
#include "numbers.h"

namespace synpo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A matrix [rows, columns] with `gap` unused values behind each row, which are NaN.
template <class T>
struct Strided {
  Strided(int row_count, int column_count, int gap, uint64_t seed)
      : rows(row_count), columns(column_count), stride(column_count + gap), values(size_t(rows) * stride, T(kNan)) {
    const std::vector<T> random = random_values<T>(size_t(rows) * columns, seed);
    for (int r = 0; r < rows; ++r) std::copy_n(random.data() + size_t(r) * columns, columns, values.data() + size_t(r) * stride);
  }
  T at(Op op, int r, int c) const { return op == Op::kAsIs ? values[size_t(r) * stride + c] : values[size_t(c) * stride + r]; }
  int rows, columns, stride;
  std::vector<T> values;
};

template <class T>
void check_gemm(Op op_a, Op op_b, int m, int n, int k, bool accumulate, int gap, uint64_t seed) {
  SCOPED_TRACE(testing::Message() << m << " x " << n << " x " << k << " ops " << int(op_a) << int(op_b) << " gap " << gap << " accumulate " << accumulate);
  const bool as_is_a = op_a == Op::kAsIs, as_is_b = op_b == Op::kAsIs;
  const Strided<T> a(as_is_a ? m : k, as_is_a ? k : m, gap, seed), b(as_is_b ? k : n, as_is_b ? n : k, 2 * gap, seed + 1);
  Strided<T> c(m, n, gap, seed + 2);
  const Strided<T> before = c;
  if (!accumulate)
    for (int i = 0; i < m; ++i) std::fill_n(c.values.data() + size_t(i) * c.stride, n, T(kNan));
  gemm(op_a, op_b, m, n, k, a.values.data(), a.stride, b.values.data(), b.stride, c.values.data(), c.stride, accumulate);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      double sum = accumulate ? double(before.at(Op::kAsIs, i, j)) : 0, size = std::abs(sum);
      for (int l = 0; l < k; ++l) {
        const double product = double(a.at(op_a, i, l)) * double(b.at(op_b, l, j));
        sum += product;
        size += std::abs(product);
      }
      ASSERT_NEAR(double(c.at(Op::kAsIs, i, j)), sum, size * std::numeric_limits<T>::epsilon() * (4 + std::sqrt(k))) << i << ", " << j;
    }
    for (int j = n; j < c.stride; ++j) ASSERT_TRUE(std::isnan(double(c.values[size_t(i) * c.stride + j]))) << "written behind row " << i;
  }
}

template <class T>
void check_gemms(int m, int n, int k, int gap, uint64_t seed) {
  for (const Op op_a : {Op::kAsIs, Op::kTransposed})
    for (const Op op_b : {Op::kAsIs, Op::kTransposed})
      for (const bool accumulate : {false, true}) check_gemm<T>(op_a, op_b, m, n, k, accumulate, gap, seed);
}

TEST(Gemm, SmallAndOddSizes) {
  for (uint64_t i = 0; i < 80; ++i) {
    Random random(1, Purpose::kInit, 5, i);
    const auto size = [&] { return 1 + int(random.below(70)); };
    const int m = size(), n = size(), k = size(), gap = int(random.below(3)) * 5;
    check_gemms<float>(m, n, k, gap, i);
    if (i % 4 == 0) check_gemms<double>(m, n, k, gap, i);
  }
}

TEST(Gemm, SizesAroundMultiplesOfVectors) {
  for (const int near : {16, 32, 48, 64})
    for (const int off : {-1, 0, 1}) {
      check_gemms<float>(near + off, 33, 17, 0, 1);
      check_gemms<float>(12, near + off, 31, 0, 2);
      check_gemms<float>(25, 32, near + off, 3, 3);
    }
  for (const auto& [m, n, k] : {std::tuple(1, 1, 1), std::tuple(1, 70, 70), std::tuple(70, 1, 70), std::tuple(70, 70, 1), std::tuple(1, 1, 300)})
    check_gemms<float>(m, n, k, 1, 4);
}

TEST(Gemm, LargerThanAnyBlock) {
  check_gemms<float>(150, 37, 1100, 0, 1);
  check_gemms<float>(37, 600, 130, 0, 2);
  check_gemms<float>(1030, 35, 40, 7, 3);
  check_gemms<float>(65, 290, 515, 0, 4);
}

TEST(Gemm, TheSameCallGivesTheSameBits) {
  const Strided<float> a(77, 130, 0, 1), b(130, 61, 0, 2);
  std::vector<float> first(77 * 61), second(77 * 61);
  gemm(Op::kAsIs, Op::kAsIs, 77, 61, 130, a.values.data(), 130, b.values.data(), 61, first.data(), 61);
  gemm(Op::kAsIs, Op::kAsIs, 77, 61, 130, a.values.data(), 130, b.values.data(), 61, second.data(), 61);
  EXPECT_EQ(first, second);
}

TEST(Gemm, ARowDependsOnNothingButThatRow) {
  constexpr int kM = 37, kN = 45, kK = 600;
  const std::vector<float> a = random_values<float>(kM * kK, 1), b = random_values<float>(kK * kN, 2);
  std::vector<float> whole(kM * kN), row(kN);
  gemm(Op::kAsIs, Op::kAsIs, kM, kN, kK, a.data(), kK, b.data(), kN, whole.data(), kN);
  for (int i = 0; i < kM; ++i) {
    gemm(Op::kAsIs, Op::kAsIs, 1, kN, kK, a.data() + i * kK, kK, b.data(), kN, row.data(), kN);
    ASSERT_TRUE(std::equal(row.begin(), row.end(), whole.begin() + i * kN)) << i;
  }
}

TEST(Gemm, APackedMatrixIsGoodForManyProducts) {
  Packed<float> packed;
  for (const auto& [n, k] : {std::pair(70, 515), std::pair(33, 20), std::pair(5, 300)})
    for (const Op op : {Op::kAsIs, Op::kTransposed}) {
      const int stride = (op == Op::kAsIs ? n : k) + 3, rows = op == Op::kAsIs ? k : n;
      const std::vector<float> b = random_values<float>(size_t(rows) * stride, 1);
      packed.pack(op, k, n, b.data(), stride);
      EXPECT_EQ(packed.k(), k);
      EXPECT_EQ(packed.n(), n);
      for (const int m : {1, 12, 29}) {
        const std::vector<float> a = random_values<float>(size_t(m) * k, 2);
        std::vector<float> got(size_t(m) * n, 1), want(size_t(m) * n, 1);
        gemm(Op::kAsIs, m, a.data(), k, packed, got.data(), n, true);
        gemm(Op::kAsIs, op, m, n, k, a.data(), k, b.data(), stride, want.data(), n, true);
        EXPECT_EQ(got, want);
      }
    }
}

TEST(Gemm, NothingToSumIsZero) {
  std::vector<float> c(6, 7);
  gemm<float>(Op::kAsIs, Op::kAsIs, 2, 3, 0, nullptr, 0, nullptr, 3, c.data(), 3, true);
  EXPECT_EQ(c, std::vector<float>(6, 7));
  gemm<float>(Op::kAsIs, Op::kAsIs, 2, 3, 0, nullptr, 0, nullptr, 3, c.data(), 3);
  EXPECT_EQ(c, std::vector<float>(6, 0));
}

TEST(Dot, IsTheSumOfProducts) {
  for (int n = 0; n < 70; ++n) {
    const std::vector<float> a = random_values<float>(n, 1), b = random_values<float>(n, 2);
    const std::vector<double> c = random_values<double>(n, 3), d = random_values<double>(n, 4);
    EXPECT_NEAR(dot(n, a.data(), b.data()), inner_product(a, b), 1e-6 * (n + 1));
    EXPECT_NEAR(dot(n, c.data(), d.data()), inner_product(c, d), 1e-14 * (n + 1));
  }
}

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
};

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
                    x[((size_t(n) * s.side + r) * s.side + q) * s.in + a] * w[((size_t(ki) * s.kernel + kj) * s.in + a) * s.out + b];
          }
  return y;
}

template <class T>
struct ConvResult {
  std::vector<T> y, dx, dw;
};

// Forward in two calls, backward with dx and dw added to what is there.
template <class T>
ConvResult<T> run_conv(const ConvShape& s, typename Conv<T>::Method method, const std::vector<T>& x, const std::vector<T>& w, const std::vector<T>& dy,
                       int threads, bool add_dx, T there) {
  Parallel parallel(threads);
  Conv<T> conv(s.side, s.in, s.out, s.kernel, s.stride, method);
  EXPECT_EQ(conv.weight_size(), w.size());
  EXPECT_EQ(conv.x_size() * s.samples, x.size());
  EXPECT_EQ(conv.y_size() * s.samples, dy.size());
  conv.prepare(parallel, w.data());
  ConvResult<T> result = {std::vector<T>(dy.size(), T(kNan)), std::vector<T>(x.size(), add_dx ? there : T(kNan)), std::vector<T>(w.size(), there)};
  Buffer<T> scratch;
  const int first = s.samples / 2;
  conv.forward(first, x.data(), result.y.data(), scratch);
  conv.forward(s.samples - first, x.data() + first * conv.x_size(), result.y.data() + first * conv.y_size(), scratch);
  typename Conv<T>::Workspace work;
  conv.backward(parallel, s.samples, x.data(), dy.data(), result.dx.data(), add_dx, result.dw.data(), work);
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
  for (const auto method : {Conv<double>::Method::kFastest, Conv<double>::Method::kDirect})
    EXPECT_LT(relative_error(run_conv<double>(s, method, x, w, dy, 1, false, 0).y, convolved(s, x, w)), 1e-13);
}

TEST_P(ConvForms, BackwardIsFiniteDifferences) {
  // The convolution is linear in x and in w, so that a step of 1 has no error but rounding.
  const auto loss = [&] { return inner_product(convolved(s, x, w), dy); };
  const std::vector<double> fixed_x = x, fixed_w = w;
  for (const bool add_dx : {false, true}) {
    const ConvResult<double> got = run_conv<double>(s, Conv<double>::Method::kFastest, fixed_x, fixed_w, dy, 2, add_dx, 0.5);
    Random random(1, Purpose::kInit, 6);
    for (int i = 0; i < 60; ++i) {
      const size_t at_x = random.below(uint32_t(x.size())), at_w = random.below(uint32_t(w.size()));
      ASSERT_NEAR(got.dx[at_x], central_difference(x[at_x], 1, loss) + (add_dx ? 0.5 : 0), 1e-10);
      ASSERT_NEAR(got.dw[at_w], central_difference(w[at_w], 1, loss) + 0.5, 1e-10);
    }
  }
}

TEST_P(ConvForms, FastestIsDirectInFloat) {
  const std::vector<float> xf(x.begin(), x.end()), wf(w.begin(), w.end()), dyf(dy.begin(), dy.end());
  const ConvResult<float> fast = run_conv<float>(s, Conv<float>::Method::kFastest, xf, wf, dyf, 1, false, 0);
  const ConvResult<float> direct = run_conv<float>(s, Conv<float>::Method::kDirect, xf, wf, dyf, 1, false, 0);
  EXPECT_LT(relative_error(fast.y, direct.y), 2e-6);
  EXPECT_LT(relative_error(fast.dx, direct.dx), 2e-6);
  EXPECT_LT(relative_error(fast.dw, direct.dw), 2e-6);
}

TEST_P(ConvForms, DxMayBeLeftOut) {
  Parallel parallel(1);
  Conv<double> conv(s.side, s.in, s.out, s.kernel, s.stride);
  conv.prepare(parallel, w.data());
  Conv<double>::Workspace work;
  std::vector<double> dw(w.size(), 0);
  conv.backward(parallel, s.samples, x.data(), dy.data(), nullptr, false, dw.data(), work);
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
  // More samples than are transformed at once, and no multiple of any unit.
  for (const ConvShape& s : {ConvShape{"", 2, 5, 6, 3, 1, 1043}, ConvShape{"", 4, 3, 4, 3, 1, 1043}, ConvShape{"", 4, 5, 3, 3, 2, 1043}}) {
    const int side_out = (s.side + s.stride - 1) / s.stride;
    const std::vector<float> x = random_values<float>(size_t(s.samples) * s.side * s.side * s.in, 1), w = random_values<float>(9 * size_t(s.in) * s.out, 2),
                             dy = random_values<float>(size_t(s.samples) * side_out * side_out * s.out, 3);
    const ConvResult<float> one = run_conv<float>(s, Conv<float>::Method::kFastest, x, w, dy, 1, true, 0.25f);
    const ConvResult<float> two = run_conv<float>(s, Conv<float>::Method::kFastest, x, w, dy, 2, true, 0.25f);
    EXPECT_EQ(one.y, two.y);
    EXPECT_EQ(one.dx, two.dx);
    EXPECT_EQ(one.dw, two.dw);
    const ConvResult<float> direct = run_conv<float>(s, Conv<float>::Method::kDirect, x, w, dy, 1, true, 0.25f);
    EXPECT_LT(relative_error(one.y, direct.y), 3e-6);
    EXPECT_LT(relative_error(one.dx, direct.dx), 3e-6);
    EXPECT_LT(relative_error(one.dw, direct.dw), 1e-5);
  }
}

}  // namespace
}  // namespace synpo
