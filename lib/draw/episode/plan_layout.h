// How large a plan is drawn beside other things.
#pragma once
#include <algorithm>

#include "draw/canvas/canvas.h"
#include "draw/face/world_face.h"

namespace synpo {

struct PlanLayout {
  int cell, wide, high;  // in pixels
};

// At most so many points wide and high, a cell at most 20.
inline PlanLayout lay_out_plan(const PlanSize& size, double wide_pt, double high_pt, const Pixels& px) {
  const int cell = px(std::min({20.0, high_pt / size.rows, wide_pt / size.columns}));
  return {cell, size.columns * cell, size.rows * cell};
}

// The side of a square of about so many points that holds a multiple of `unit` pixels.
inline int square_side(double pt, int unit, const Pixels& px) { return unit * px(pt / unit); }

}  // namespace synpo
