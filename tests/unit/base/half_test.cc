#include "base/half.h"

#include <gtest/gtest.h>

#include "base/hash.h"

namespace synpo {
namespace {

TEST(Half, EveryOneComesBack) {
  for (uint32_t bits = 0; bits < 0x10000; ++bits) {
    const Half half = {uint16_t(bits)};
    EXPECT_EQ(is_finite(half), (bits & 0x7fff) < 0x7c00);
    if (!is_finite(half)) continue;
    const int exponent = int(bits >> 10 & 31), mantissa = int(bits & 1023);
    const double value = exponent ? std::ldexp(1024 + mantissa, exponent - 25) : std::ldexp(mantissa, -24);
    ASSERT_EQ(to_float(half), float(bits & 0x8000 ? -value : value)) << bits;
    ASSERT_EQ(to_half(to_float(half)).bits, bits);
  }
}

TEST(Half, TheNearestIsTakenAndOfTwoTheEven) {
  for (uint32_t bits = 0; bits < 0x7bff; ++bits) {
    const float low = to_float({uint16_t(bits)}), high = to_float({uint16_t(bits + 1)}), middle = (low + high) / 2;
    ASSERT_EQ(to_half(middle).bits, bits + (bits & 1));
    ASSERT_EQ(to_half(std::nextafter(middle, low)).bits, bits);
    ASSERT_EQ(to_half(-std::nextafter(middle, high)).bits, 0x8000 + bits + 1);
  }
}

}  // namespace
}  // namespace synpo
