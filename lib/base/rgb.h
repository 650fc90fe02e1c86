// A colour of a picture.
#pragma once
#include <cstdint>

namespace synpo {

struct Rgb {
  uint8_t r, g, b;
  bool operator==(const Rgb&) const = default;
};

}  // namespace synpo
