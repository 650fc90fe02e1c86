// The shapes of the objects: a few boxes each.
#pragma once
#include <span>

#include "world/kitchen/geometry/ray.h"

namespace synpo {

// In cells, from the middle of the foot of the object.
struct ObjectPart {
  Vec3 low, high;
  bool trim;  // in the object's second colour
};

std::span<const ObjectPart> object_parts(int object);

}  // namespace synpo
