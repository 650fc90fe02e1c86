// The way of an agent through a maze, light where it begins and dark where it ends.
#pragma once
#include <cstdint>
#include <vector>

#include "draw/maze_picture.h"

namespace synpo {

// From 0, the start, to 1, the last step; darkness rises strictly, hue runs from yellow to purple.
Rgb time_colour(double share);

constexpr int kPathLanes = 5;

// The corners of the way, in pixels. Ways that pass the same border of two cells again run beside one another, in up to kPathLanes
// lanes; `cells` is where the agent was at every moment.
struct PathCorner {
  Point at;
  int step;  // the number of the step, from 1, that leads here; 0 at the start
};
std::vector<PathCorner> path_corners(const MazePlace& place, const std::vector<uint8_t>& cells);

// `steps` is the step whose colour is darkest. With arrowheads on the way.
void draw_path(Canvas& canvas, const MazePlace& place, const std::vector<uint8_t>& cells, int steps);

}  // namespace synpo
