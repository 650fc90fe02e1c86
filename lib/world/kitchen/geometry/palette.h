// The colours of kitchens. Floor, walls and furniture have a kitchen's own, pale ones; objects and receptacles strong
// ones, the same everywhere.
#pragma once
#include <array>
#include <cstdint>

#include "world/kitchen/geometry/kitchen.h"

namespace synpo {

struct Colour {
  float r, g, b;  // 0 to 255
};

struct KitchenPalette {
  explicit KitchenPalette(uint64_t hash);
  std::array<Colour, 2> floor;   // tiles
  Colour wall, band;             // the band runs around the walls above the counters
  std::array<Colour, 8> panels;  // of which pictures hang on the walls
  Colour cabinet, counter_top, table;
};

extern const Colour kCeilingColour, kInsideColour, kShelfColour;  // inside of an open receptacle
extern const std::array<Colour, kKitchenReceptacles> kReceptacleColours;
extern const std::array<std::array<Colour, 2>, kKitchenObjects> kObjectColours;  // body and trim

inline Colour mix(const Colour& colour, float factor) {
  return {colour.r * factor, colour.g * factor, colour.b * factor};
}

}  // namespace synpo
