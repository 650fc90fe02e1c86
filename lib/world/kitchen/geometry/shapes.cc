#include "world/kitchen/geometry/shapes.h"

#include "world/kitchen/geometry/kitchen.h"

namespace synpo {
namespace {

// A part by its middle, its sizes and its heights in metres.
constexpr ObjectPart part(float x, float y, float width, float depth, float z_low, float z_high, bool trim = false) {
  return {{in_cells(x - width / 2), in_cells(y - depth / 2), in_cells(z_low)},
          {in_cells(x + width / 2), in_cells(y + depth / 2), in_cells(z_high)},
          trim};
}

constexpr ObjectPart kContainer[] = {part(0, 0, 0.17f, 0.15f, 0, 0.11f), part(0, 0, 0.18f, 0.16f, 0.11f, 0.14f, true)};
constexpr ObjectPart kLettuce[] = {part(0, 0, 0.18f, 0.18f, 0.02f, 0.12f), part(0, 0, 0.12f, 0.12f, 0, 0.17f),
                                   part(0, 0, 0.05f, 0.05f, 0.17f, 0.19f, true)};
constexpr ObjectPart kMug[] = {part(-0.02f, 0, 0.1f, 0.1f, 0, 0.13f), part(0.05f, 0, 0.04f, 0.025f, 0.03f, 0.1f, true),
                               part(-0.02f, 0, 0.07f, 0.07f, 0.13f, 0.132f, true)};
constexpr ObjectPart kTomato[] = {part(0, 0, 0.14f, 0.14f, 0, 0.12f), part(0, 0, 0.06f, 0.06f, 0.12f, 0.135f, true)};
constexpr ObjectPart kPlate[] = {part(0, 0, 0.22f, 0.22f, 0.015f, 0.04f), part(0, 0, 0.12f, 0.12f, 0, 0.042f, true)};
constexpr ObjectPart kApple[] = {part(0, 0, 0.13f, 0.13f, 0, 0.12f), part(0, 0, 0.02f, 0.02f, 0.12f, 0.16f, true)};
constexpr ObjectPart kBowl[] = {part(0, 0, 0.1f, 0.1f, 0, 0.03f), part(0, 0, 0.2f, 0.2f, 0.03f, 0.09f),
                                part(0, 0, 0.15f, 0.15f, 0.09f, 0.092f, true)};

constexpr std::span<const ObjectPart> kParts[kKitchenObjects] = {kContainer, kLettuce, kMug, kTomato,
                                                                 kPlate,     kApple,   kBowl};

}  // namespace

std::span<const ObjectPart> object_parts(int object) { return kParts[object]; }

}  // namespace synpo
