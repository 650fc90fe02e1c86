// The colour that a ray brings back: that of the thing, some sides and distances darker than others.
#pragma once
#include "world/kitchen/geometry/palette.h"
#include "world/kitchen/geometry/ray.h"

namespace synpo {

// `length` is the direction's, in cells. Bit i of `doors`: receptacle i is open.
Colour colour_of_hit(const SolidsView& view, int doors, const Hit& hit, const Vec3& direction, float length);

}  // namespace synpo
