// The kernels of every target that runs here, against definitions and against one another.
#include "kernel/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstring>
#include <limits>
#include <tuple>

#include "base/error.h"
#include "helpers/numbers.h"
#include "helpers/targets.h"
#include "nn/gemm.h"

namespace synpo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A matrix [rows, columns] with `gap` unused values after each row, which are NaN.
template <class T>
struct Strided {
  Strided(int row_count, int column_count, int gap, uint64_t seed)
      : rows(row_count), columns(column_count), stride(column_count + gap), values(size_t(rows) * stride, T(kNan)) {
    const std::vector<T> random = random_values<T>(size_t(rows) * columns, seed);
    for (int r = 0; r < rows; ++r)
      std::copy_n(random.data() + size_t(r) * columns, columns, values.data() + size_t(r) * stride);
  }
  T at(Op op, int r, int c) const {
    return op == Op::kAsIs ? values[size_t(r) * stride + c] : values[size_t(c) * stride + r];
  }
  int rows, columns, stride;
  std::vector<T> values;
};

template <class T>
void check_gemm(const NamedKernels<T>& target, Op op_a, Op op_b, int m, int n, int k, bool accumulate, int gap,
                uint64_t seed) {
  SCOPED_TRACE(testing::Message() << target.name << ": " << m << " x " << n << " x " << k << " ops " << int(op_a)
                                  << int(op_b) << " gap " << gap << " accumulate " << accumulate);
  const bool as_is_a = op_a == Op::kAsIs, as_is_b = op_b == Op::kAsIs;
  const Strided<T> a(as_is_a ? m : k, as_is_a ? k : m, gap, seed),
      b(as_is_b ? k : n, as_is_b ? n : k, 2 * gap, seed + 1);
  Strided<T> c(m, n, gap, seed + 2);
  const Strided<T> before = c;
  if (!accumulate)
    for (int i = 0; i < m; ++i) std::fill_n(c.values.data() + size_t(i) * c.stride, n, T(kNan));
  const Kernels<T>& kernels = *target.kernels;
  Buffer<T> packed;
  kernels.pack(op_b, k, n, b.values.data(), b.stride, packed.grow(kernels.packed_size(k, n)));
  kernels.multiply(op_a, m, n, k, a.values.data(), a.stride, packed.data(), c.values.data(), c.stride, accumulate);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      double sum = accumulate ? double(before.at(Op::kAsIs, i, j)) : 0, size = std::abs(sum);
      for (int l = 0; l < k; ++l) {
        const double product = double(a.at(op_a, i, l)) * double(b.at(op_b, l, j));
        sum += product;
        size += std::abs(product);
      }
      ASSERT_NEAR(double(c.at(Op::kAsIs, i, j)), sum,
                  size * (kernels.product_error + std::numeric_limits<T>::epsilon() * (4 + std::sqrt(k))))
          << i << ", " << j;
    }
    for (int j = n; j < c.stride; ++j)
      ASSERT_TRUE(std::isnan(double(c.values[size_t(i) * c.stride + j]))) << "written after row " << i;
  }
}

template <class T>
void check_gemms(int m, int n, int k, int gap, uint64_t seed) {
  for (const NamedKernels<T>& target : all_kernels<T>())
    for (const Op op_a : {Op::kAsIs, Op::kTransposed})
      for (const Op op_b : {Op::kAsIs, Op::kTransposed})
        for (const bool accumulate : {false, true}) check_gemm<T>(target, op_a, op_b, m, n, k, accumulate, gap, seed);
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
      check_gemms<float>(near + off, 64, 290, 0, 4);
      check_gemms<float>(25, 32, near + off, 3, 3);
    }
  for (const auto& [m, n, k] : {std::tuple(1, 1, 1), std::tuple(1, 70, 70), std::tuple(70, 1, 70),
                                std::tuple(70, 70, 1), std::tuple(1, 1, 300)})
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

TEST(Gemm, ThreadsPackToTheSameBytes) {
  Parallel parallel(2);
  for_every_target([&](const std::string&) {
    for (const auto& [n, k] : {std::pair(1030, 255), std::pair(1030, 256), std::pair(1030, 257), std::pair(401, 1100)})
      for (const Op op : {Op::kAsIs, Op::kTransposed}) {
        const int stride = (op == Op::kAsIs ? n : k) + 3;
        const std::vector<float> b = random_values<float>(size_t(op == Op::kAsIs ? k : n) * stride, 1);
        Packed<float> alone, together;
        alone.pack(op, k, n, b.data(), stride);
        together.pack(parallel, op, k, n, b.data(), stride);
        EXPECT_EQ(together.k(), k);
        EXPECT_EQ(together.n(), n);
        EXPECT_EQ(std::memcmp(together.data(), alone.data(), kernels<float>().packed_size(k, n) * sizeof(float)), 0)
            << k << " x " << n;
      }
  });
}

TEST(Gemm, NothingToSumIsZero) {
  std::vector<float> c(6, 7);
  gemm<float>(Op::kAsIs, Op::kAsIs, 2, 3, 0, nullptr, 0, nullptr, 3, c.data(), 3, true);
  EXPECT_EQ(c, std::vector<float>(6, 7));
  gemm<float>(Op::kAsIs, Op::kAsIs, 2, 3, 0, nullptr, 0, nullptr, 3, c.data(), 3);
  EXPECT_EQ(c, std::vector<float>(6, 0));
}

TEST(Gemm, IsEigensProductOnOddSizes) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (const auto& [m, n, k] :
       {std::tuple(7, 13, 29), std::tuple(61, 33, 259), std::tuple(129, 65, 31), std::tuple(1, 127, 513)}) {
    const std::vector<float> a = random_values<float>(size_t(m) * k, 1), b = random_values<float>(size_t(k) * n, 2);
    const Eigen::Map<const Matrix> left(a.data(), m, k), right(b.data(), k, n);
    const Matrix want = left * right;
    const Matrix size = left.cwiseAbs() * right.cwiseAbs();
    for (const NamedKernels<float>& target : all_kernels<float>()) {
      Buffer<float> packed;
      std::vector<float> got(size_t(m) * n);
      target.kernels->pack(Op::kAsIs, k, n, b.data(), n, packed.grow(target.kernels->packed_size(k, n)));
      target.kernels->multiply(Op::kAsIs, m, n, k, a.data(), k, packed.data(), got.data(), n, false);
      const double bound = target.kernels->product_error + 0x1p-23 * (4 + std::sqrt(k));
      for (int i = 0; i < m * n; ++i)
        ASSERT_NEAR(got[i], want.data()[i], bound * size.data()[i]) << target.name << " at " << i;
    }
  }
}

TEST(Gemm, WidthOfTheVectorsDoesNotShowInTheBits) {
  const auto all = all_kernels<float>();
  const auto find = [&](const std::string& name) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& target) { return target.name == name; });
    return found == all.end() ? nullptr : found->kernels;
  };
  const Kernels<float>*narrow = find("avx2"), *wide = find("avx512");
  if (!narrow || !wide) GTEST_SKIP() << "this processor has not both avx2 and avx512";
  constexpr int kM = 37, kN = 70, kK = 300;
  const std::vector<float> a = random_values<float>(kM * kK, 1), b = random_values<float>(kK * kN, 2);
  std::vector<float> c[2];
  for (const Kernels<float>* kernels : {narrow, wide}) {
    std::vector<float>& to = c[kernels == wide];
    to.resize(kM * kN);
    Buffer<float> packed;
    kernels->pack(Op::kAsIs, kK, kN, b.data(), kN, packed.grow(kernels->packed_size(kK, kN)));
    kernels->multiply(Op::kAsIs, kM, kN, kK, a.data(), kK, packed.data(), to.data(), kN, false);
  }
  EXPECT_EQ(c[0], c[1]);
  for (int n = 0; n <= kK; ++n) {
    EXPECT_EQ(narrow->dot(n, a.data(), b.data()), wide->dot(n, a.data(), b.data())) << n;
    EXPECT_EQ(narrow->sum_of_squares(size_t(n), a.data()), wide->sum_of_squares(size_t(n), a.data())) << n;
  }
}

template <class T>
class Rows : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Rows, Scalars);

// Every pass of every target against its definition, on odd numbers of channels.
TYPED_TEST(Rows, AreTheirDefinitions) {
  using T = TypeParam;
  const double near = std::is_same_v<T, float> ? 1e-5 : 1e-13;
  for (const NamedKernels<T>& target : all_kernels<T>())
    for (const int channels : {1, 5, 16, 35}) {
      SCOPED_TRACE(testing::Message() << target.name << ", " << channels << " channels");
      constexpr size_t kRows = 67;
      const size_t size = kRows * channels;
      const Kernels<T>& k = *target.kernels;
      const std::vector<T> z = random_values<T>(size, 1), other = random_values<T>(size, 2),
                           d = random_values<T>(size, 3), scale = random_values<T>(channels, 4),
                           offset = random_values<T>(channels, 5), mean = random_values<T>(channels, 6),
                           by = random_values<T>(channels, 7);
      std::vector<T> y(size), plain(size), scaled(size), masked = d, biased = z, summed(size), dz(size),
                                                         dz_masked(size);
      std::vector<double> sum(channels, 1), squares(channels, 2), dsum(channels, 3), products(channels, 4),
          msum(channels, 5), mproducts(channels, 6);
      k.norm_relu(kRows, channels, z.data(), scale.data(), offset.data(), y.data());
      k.norm_add_relu(kRows, channels, z.data(), scale.data(), offset.data(), other.data(), nullptr, nullptr,
                      plain.data());
      k.norm_add_relu(kRows, channels, z.data(), scale.data(), offset.data(), other.data(), by.data(), mean.data(),
                      scaled.data());
      k.relu_mask(size, masked.data(), y.data());
      k.add_bias(int(kRows), channels, offset.data(), true, biased.data());
      k.add_moments(kRows, channels, z.data(), mean.data(), sum.data(), squares.data());
      k.add_products(kRows, channels, d.data(), z.data(), mean.data(), dsum.data(), products.data());
      k.add_masked_products(kRows, channels, d.data(), z.data(), mean.data(), scale.data(), offset.data(), msum.data(),
                            mproducts.data());
      k.norm_backward(kRows, channels, d.data(), z.data(), by.data(), mean.data(), offset.data(), nullptr, nullptr,
                      dz.data());
      k.norm_backward(kRows, channels, d.data(), z.data(), by.data(), mean.data(), offset.data(), scale.data(),
                      offset.data(), dz_masked.data());
      const T* from[2] = {z.data(), other.data()};
      const T factors[2] = {T(2), T(-0.5)};
      k.combine(2, from, factors, size, summed.data(), false);
      for (size_t i = 0; i < size; ++i) {
        const int c = int(i % channels);
        const double value = double(z[i]) * scale[c] + offset[c], kept = y[i] > 0 ? double(d[i]) : 0;
        ASSERT_NEAR(y[i], std::max(0.0, value), near);
        ASSERT_NEAR(plain[i], std::max(0.0, value + other[i]), near);
        ASSERT_NEAR(scaled[i], std::max(0.0, value + double(other[i]) * by[c] + mean[c]), near);
        ASSERT_EQ(masked[i], T(kept));
        ASSERT_NEAR(biased[i], std::max(0.0, double(z[i]) + offset[c]), near);
        ASSERT_NEAR(summed[i], 2.0 * z[i] - 0.5 * other[i], near);
        ASSERT_NEAR(dz[i], double(d[i]) * by[c] + double(z[i]) * mean[c] + offset[c], near);
        ASSERT_NEAR(dz_masked[i], kept * by[c] + double(z[i]) * mean[c] + offset[c], near);
        const double centred = double(z[i]) - mean[c];
        sum[c] -= centred;
        squares[c] -= centred * centred;
        dsum[c] -= d[i];
        products[c] -= d[i] * centred;
        msum[c] -= kept;
        mproducts[c] -= kept * centred;
      }
      const std::vector<double>* rest[6] = {&sum, &squares, &dsum, &products, &msum, &mproducts};
      for (int q = 0; q < 6; ++q)
        for (int c = 0; c < channels; ++c) ASSERT_NEAR((*rest[q])[c], q + 1, kRows * near) << q << ", " << c;
    }
}

TYPED_TEST(Rows, RmsPropAndSumsOfSquaresAreTheirDefinitions) {
  using T = TypeParam;
  const double near = std::is_same_v<T, float> ? 1e-5 : 1e-13;
  for (const NamedKernels<T>& target : all_kernels<T>())
    for (const size_t n : {size_t(0), size_t(1), size_t(31), size_t(32), size_t(1003)}) {
      SCOPED_TRACE(testing::Message() << target.name << ", " << n << " values");
      const std::vector<T> gradient = random_values<T>(n, 1), start = random_values<T>(n, 2);
      std::vector<T> parameter = start, v(n, T(0.25));
      target.kernels->rmsprop(n, {T(0.5), T(0.125), T(0.75), T(0.1), T(0.5)}, gradient.data(), parameter.data(),
                              v.data());
      double squares = 0;
      for (size_t i = 0; i < n; ++i) {
        const double g = 0.5 * gradient[i] + 0.125 * start[i], mean = 0.75 * 0.25 + 0.25 * g * g;
        ASSERT_NEAR(v[i], mean, near);
        ASSERT_NEAR(parameter[i], start[i] - 0.1 * g / (std::sqrt(mean) + 0.5), near);
        squares += double(gradient[i]) * gradient[i];
      }
      EXPECT_NEAR(target.kernels->sum_of_squares(n, gradient.data()), squares, 1e-12 * double(n + 1));
    }
}

TYPED_TEST(Rows, DotIsTheSumOfProducts) {
  using T = TypeParam;
  for (const NamedKernels<T>& target : all_kernels<T>())
    for (int n = 0; n < 70; ++n) {
      const std::vector<T> a = random_values<T>(n, 1), b = random_values<T>(n, 2);
      EXPECT_NEAR(target.kernels->dot(n, a.data(), b.data()), inner_product(a, b),
                  (std::is_same_v<T, float> ? 1e-6 : 1e-14) * (n + 1));
    }
}

TEST(Kernels, AnUnknownTargetIsRefused) {
  const std::string before = kernel_target();
  try {
    choose_kernels("nonsense");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::kUsage);
    EXPECT_NE(std::string(error.what()).find("plain"), std::string::npos) << "the message should list what runs here";
  }
  EXPECT_EQ(kernel_target(), before);
}

TEST(Kernels, ATargetIsChosen) {
  const auto all = all_kernels<float>();
  ASSERT_FALSE(all.empty());
  EXPECT_EQ(all.front().name, "plain");
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [](const auto& target) {
    return target.name == kernel_target() && target.kernels == &kernels<float>();
  }));
}

}  // namespace
}  // namespace synpo
