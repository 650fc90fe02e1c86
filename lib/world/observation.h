// The make-up of an observation: a world says it, and a policy's encoder is chosen and sized by it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/rgb.h"

namespace synpo {

constexpr int kHistory = 4;  // states whose views are in an observation

enum class Sight : uint8_t { kPictures, kFeatures };

struct ObservationSpec {
  Sight sight = Sight::kPictures;

  // Pictures: uint8 [side, side, kHistory] of indices into the palette, oldest first. Before the first step the earlier
  // pictures are missing: 0.
  int side = 0;
  std::vector<Rgb> palette = {};

  // Features: float [kHistory, view], oldest first, a missing view zero; then kObjectFloats more, the first of which is
  // the number, from 0 to objects - 1, of a thing that no view shows, the rest zero.
  int view = 0, objects = 0;
  static constexpr int kObjectFloats = 16;

  static constexpr int kChannels = 3 * kHistory;  // of pictures, once their colours are looked up

  size_t bytes() const {
    if (sight == Sight::kPictures) return size_t(side) * side * kHistory;
    return (size_t(kHistory) * view + kObjectFloats) * sizeof(float);
  }
  bool operator==(const ObservationSpec&) const = default;
};

}  // namespace synpo
