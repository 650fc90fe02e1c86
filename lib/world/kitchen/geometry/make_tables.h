// The tables of a kitchen from its plan.
//
// Poses: floor cells row by row, four headings, horizons -30 (up), 0, 30 (down); episodes start level. A thing is
// visible that lies in the field of view of 60 degrees, at most 1.5 m away (horizontally, between the middles), with
// nothing in between but other objects: the ray from the eye at 1.5 m to its middle meets nothing before it. Slots are
// cells of counters and tables, at most kMaxKitchenSlots, each with some pose from which it is nearer than every other,
// so that whatever lies there can be picked up whatever lies elsewhere.
#pragma once
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"

namespace synpo {

constexpr int kSightCells = 6;  // 1.5 m

// Throws kData, naming the kitchen, where there are fewer slots than objects.
KitchenTables kitchen_tables(const Kitchen& kitchen, const KitchenSolids& solids);

}  // namespace synpo
