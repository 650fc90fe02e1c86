// The agent's view of a kitchen: a pinhole picture of 60 degrees both ways. Colours of floor, walls and counters are
// the kitchen's own; those of objects and receptacles are the same everywhere. A receptacle that is open shows a dark
// inside in a frame of its colour. What is in the hand is not drawn.
#pragma once
#include <array>
#include <cstdint>

#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"

namespace synpo {

// The part of a state that can be seen.
struct KitchenFrame {
  KitchenPose eye = {};
  uint8_t doors = 0;
  std::array<int16_t, kKitchenObjects> objects = {-1, -1, -1, -1,
                                                  -1, -1, -1};  // ray_cell() of each, -1 where it does not lie anywhere
  bool operator==(const KitchenFrame&) const = default;
};

// rgb [height, width, 3].
void render(const KitchenSolids& solids, const KitchenFrame& frame, int width, int height, uint8_t* rgb);

// The same picture at kSmallView x kSmallView, faster: the ways of its rays are stored.
constexpr int kSmallView = 32;
void render_small(const KitchenSolids& solids, const KitchenFrame& frame, uint8_t* rgb);

}  // namespace synpo
