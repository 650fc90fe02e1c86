#include "draw/canvas/shapes.h"

#include <cstddef>
#include <utility>

namespace synpo {
namespace {

// Far enough outside any picture, and small enough to compute with.
constexpr double kFar = 1e7;

Point bounded(Point p) { return {std::clamp(p.x, -kFar, kFar), std::clamp(p.y, -kFar, kFar)}; }
Point between(Point a, Point b, double share) { return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)}; }

// The shares of the way from a to b between which it is inside the bounds (Liang and Barsky 1984); false where it is
// nowhere.
bool clip_piece(Point a, Point b, Point low, Point high, double& from, double& to) {
  from = 0;
  to = 1;
  const double p[] = {a.x - b.x, b.x - a.x, a.y - b.y, b.y - a.y};
  const double q[] = {a.x - low.x, high.x - a.x, a.y - low.y, high.y - a.y};
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0 && q[i] < 0) return false;
    if (p[i] < 0) from = std::max(from, q[i] / p[i]);
    if (p[i] > 0) to = std::min(to, q[i] / p[i]);
  }
  return from <= to;
}

}  // namespace

std::vector<LinePart> visible_parts(const std::vector<Point>& points, double width, const Dash& dash, const Box& box) {
  if (points.size() == 1) return {{{bounded(points[0])}, {}}};
  const Point low = {box.x - width, box.y - width}, high = {box.right() + width, box.bottom() + width};
  const double period = dash.on + dash.off;
  std::vector<LinePart> parts;
  double before = 0;  // length of the line up to the piece
  bool goes_on = false;
  for (size_t i = 1; i < points.size(); ++i) {
    const Point a = bounded(points[i - 1]), b = bounded(points[i]);
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    double from, to;
    if (clip_piece(a, b, low, high, from, to)) {
      if (!goes_on || from > 0) {
        const double begin = before + from * length;
        parts.push_back({{between(a, b, from)}, dash});
        if (dash.off > 0) parts.back().dash.from = std::fmod(dash.from + begin, period);
      }
      parts.back().points.push_back(between(a, b, to));
      goes_on = to == 1;
    } else {
      goes_on = false;
    }
    before += length;
  }
  return parts;
}

// One side after another (Sutherland and Hodgman 1974).
std::vector<Point> clipped_polygon(std::vector<Point> corners, const Box& box) {
  for (Point& corner : corners) corner = bounded(corner);
  const auto cut = [&](auto inside) {
    std::vector<Point> kept;
    for (size_t i = 0; i < corners.size(); ++i) {
      const Point a = corners[i], b = corners[(i + 1) % corners.size()];
      const double at_a = inside(a), at_b = inside(b);
      if (at_a >= 0) kept.push_back(a);
      if ((at_a >= 0) != (at_b >= 0)) kept.push_back(between(a, b, at_a / (at_a - at_b)));
    }
    corners = std::move(kept);
  };
  cut([&](Point p) { return p.x - box.x; });
  cut([&](Point p) { return box.right() - p.x; });
  cut([&](Point p) { return p.y - box.y; });
  cut([&](Point p) { return box.bottom() - p.y; });
  return corners;
}

}  // namespace synpo
