// Names beside the points of a scatter plot, so that they cover neither points nor one another where there is room.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"

namespace synpo {

struct LabelledPoint {
  Box marker;
  std::string name;
};

// The boxes of the names, in order: each goes to the side of its marker where it covers least of what is there already,
// within `plot`.
std::vector<Box> place_labels(const std::vector<LabelledPoint>& points, int size, const Box& plot, const Font& font);

}  // namespace synpo
