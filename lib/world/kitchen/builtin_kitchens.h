// The nineteen kitchens that are built in: plans made up from their numbers, with the sizes of those that Table 1
// names.
#pragma once
#include <vector>

#include "world/kitchen/geometry/kitchen.h"

namespace synpo {

// FloorPlan1 to FloorPlan30, those of Table 1, by number.
const std::vector<Kitchen>& builtin_kitchens();

}  // namespace synpo
