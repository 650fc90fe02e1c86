// Half precision (IEEE binary16), for what is stored and not computed with.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace synpo {

struct Half {
  uint16_t bits;
};

constexpr float kHalfMax = 65504;

inline bool is_finite(Half half) { return (half.bits & 0x7c00) != 0x7c00; }

// The value of a finite one, exactly, also where the processor takes numbers too small for a normal float as zero
// (parallel.h).
inline float to_float(Half half) {
  const float normal = std::bit_cast<float>(uint32_t(half.bits & 0x7fff) << 13) * 0x1p112f,
              small = float(half.bits & 0x3ff) * 0x1p-24f;
  const float magnitude = half.bits & 0x7c00 ? normal : small;
  return std::bit_cast<float>(std::bit_cast<uint32_t>(magnitude) | uint32_t(half.bits & 0x8000) << 16);
}

// The nearest one, ties to even. |value| <= kHalfMax.
inline Half to_half(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value), sign = bits >> 16 & 0x8000;
  const float magnitude = std::fabs(value);
  if (magnitude < 0x1p-14f) return {uint16_t(sign | uint32_t(std::nearbyint(magnitude * 0x1p24f)))};
  const uint32_t rounded = (bits & 0x7fffffff) + 0xfff + (bits >> 13 & 1);
  return {uint16_t(sign | (rounded - (112u << 23)) >> 13)};
}

}  // namespace synpo
