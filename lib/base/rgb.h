// A colour of a picture.
#pragma once
#include <cstdint>

namespace synpo {

struct Rgb {
  uint8_t r, g, b;
};

}  // namespace synpo
