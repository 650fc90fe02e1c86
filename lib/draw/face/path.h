// The way of an agent over a plan, light where it begins and dark where it ends.
#pragma once
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/face/plan_grid.h"

namespace synpo {

constexpr int kPathLanes = 5;

// The corners of the way, in pixels. Ways that pass the same border of two cells again run beside one another, in up to
// kPathLanes lanes; `cells` is where the agent was at every moment.
struct PathCorner {
  Point at;
  int step;  // the number of the step, from 1, that leads here; 0 at the start
};
std::vector<PathCorner> path_corners(const PlanGrid& place, const std::vector<int>& cells);

// `direction` has unit length.
void draw_arrowhead(Canvas& canvas, Point tip, Point direction, double size, Rgb colour);
// `steps` is the step whose colour is darkest, `ground` the colour of a thin border. With arrowheads on the way.
void draw_path(Canvas& canvas, const PlanGrid& place, const std::vector<int>& cells, int steps, Rgb ground);

// How often each cell is among `cells`, in a corner of those where the path cannot tell: more than kPathLanes. Small
// cells have no room for that.
void draw_counts(Canvas& canvas, const PlanGrid& place, const std::vector<int>& cells);
bool has_counts(int cell, const std::vector<int>& cells);
void draw_count_sign(Canvas& canvas, const Box& box);

// The ring where the way begins.
void draw_start(Canvas& canvas, const Box& box);

}  // namespace synpo
