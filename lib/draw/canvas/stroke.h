// Smooth lines and bands for plots: how much of each pixel they cover.
#pragma once
#include <vector>

#include "draw/canvas/canvas.h"

namespace synpo {

// Lengths in pixels along the line; off = 0 is a line without gaps.
struct Dash {
  double on = 0, off = 0;
};

// The line through the points, `width` pixels wide, with round joins and ends; a single point is a disc twice as wide.
// What lies outside `clip` is left out.
Mask stroke_mask(const std::vector<Point>& points, double width, const Dash& dash, const Box& clip);

// The area between two lines with the same x, which rise: `upper` has the smaller y.
Mask band_mask(const std::vector<Point>& upper, const std::vector<Point>& lower, const Box& clip);

}  // namespace synpo
