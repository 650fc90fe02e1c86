// What a canvas is drawn with: points, boxes and lengths in pixels.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace synpo {

struct Point {
  double x, y;
};

struct Box {
  int x, y, width, height;
  int right() const { return x + width; }
  int bottom() const { return y + height; }
  Point centre() const { return {x + width / 2.0, y + height / 2.0}; }
  // So many pixels smaller at every side.
  Box inset(int by) const { return {x + by, y + by, width - 2 * by, height - 2 * by}; }
};

// Points to pixels: at least one.
struct Pixels {
  double scale;
  int operator()(double pt) const { return std::max(1, int(std::lround(pt * scale))); }
};

// Lengths in pixels along the line; off = 0 is a line without gaps. `from` is where the first dash begins, so far
// before the line does.
struct Dash {
  double on = 0, off = 0, from = 0;
};

// The parts of the line through the points that may be seen in `box`, of a line so many pixels wide, each with its own
// dash, so that the whole is the line as it would be drawn. A single point is a part of its own.
struct LinePart {
  std::vector<Point> points;
  Dash dash;
};
std::vector<LinePart> visible_parts(const std::vector<Point>& points, double width, const Dash& dash, const Box& box);

// The part of the polygon within the box.
std::vector<Point> clipped_polygon(std::vector<Point> corners, const Box& box);

}  // namespace synpo
