#include "draw/canvas/stroke.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace synpo {
namespace {

// Far enough outside any picture, and small enough to compute with.
constexpr double kFar = 1e7;

Point bounded(Point p) { return {std::clamp(p.x, -kFar, kFar), std::clamp(p.y, -kFar, kFar)}; }
Point between(Point a, Point b, double share) { return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)}; }
uint8_t byte_of(double coverage) { return uint8_t(std::lround(255 * std::clamp(coverage, 0.0, 1.0))); }

// Covers the pixels within `radius` of the piece from a to b; a pixel keeps the most that any piece gives it.
void cover_piece(Mask& mask, Point a, Point b, double radius) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy, reach = radius + 1;
  const Box& box = mask.box;
  const int left = std::max(box.x, int(std::floor(std::min(a.x, b.x) - reach)));
  const int right = std::min(box.right(), int(std::ceil(std::max(a.x, b.x) + reach)));
  const int top = std::max(box.y, int(std::floor(std::min(a.y, b.y) - reach)));
  const int bottom = std::min(box.bottom(), int(std::ceil(std::max(a.y, b.y) + reach)));
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
      const double along = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0;
      const double distance = std::hypot(px - along * dx, py - along * dy);
      uint8_t& coverage = mask.coverage[size_t(y - box.y) * box.width + (x - box.x)];
      coverage = std::max(coverage, byte_of(radius + 0.5 - distance));
    }
}

// The shares of the way from a to b between which it is inside the box (Liang and Barsky 1984); false where it is
// nowhere.
bool clip_piece(Point a, Point b, double left, double top, double right, double bottom, double& from, double& to) {
  from = 0;
  to = 1;
  const double p[] = {a.x - b.x, b.x - a.x, a.y - b.y, b.y - a.y};
  const double q[] = {a.x - left, right - a.x, a.y - top, bottom - a.y};
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0 && q[i] < 0) return false;
    if (p[i] < 0) from = std::max(from, q[i] / p[i]);
    if (p[i] > 0) to = std::min(to, q[i] / p[i]);
  }
  return from <= to;
}

}  // namespace

Mask stroke_mask(const std::vector<Point>& points, double width, const Dash& dash, const Box& clip) {
  Mask mask{clip, std::vector<uint8_t>(size_t(clip.width) * clip.height)};
  const double radius = width / 2, period = dash.on + dash.off;
  if (points.size() == 1) cover_piece(mask, bounded(points[0]), bounded(points[0]), width);
  double before = 0;  // length of the line up to the piece
  for (size_t i = 1; i < points.size(); ++i) {
    const Point a = bounded(points[i - 1]), b = bounded(points[i]);
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    double from, to;
    if (clip_piece(a, b, clip.x - width, clip.y - width, clip.right() + width, clip.bottom() + width, from, to)) {
      if (dash.off <= 0 || length == 0) {
        cover_piece(mask, between(a, b, from), between(a, b, to), radius);
      } else {
        const double begin = before + from * length, end = before + to * length;
        for (double start = std::floor(begin / period) * period; start < end; start += period) {
          const double low = std::max(start, begin), high = std::min(start + dash.on, end);
          if (low < high)
            cover_piece(mask, between(a, b, (low - before) / length), between(a, b, (high - before) / length), radius);
        }
      }
    }
    before += length;
  }
  return mask;
}

Mask band_mask(const std::vector<Point>& upper, const std::vector<Point>& lower, const Box& clip) {
  constexpr int kSamples = 4;  // across a pixel
  Mask mask{clip, std::vector<uint8_t>(size_t(clip.width) * clip.height)};
  std::vector<double> covered(clip.height);
  size_t right = 1;
  for (int column = 0; column < clip.width && right < upper.size(); ++column) {
    std::fill(covered.begin(), covered.end(), 0.0);
    for (int sample = 0; sample < kSamples; ++sample) {
      const double x = clip.x + column + (sample + 0.5) / kSamples;
      while (right < upper.size() && upper[right].x < x) ++right;
      if (right == upper.size()) break;
      if (x < upper[right - 1].x) continue;
      const double share = (x - upper[right - 1].x) / (upper[right].x - upper[right - 1].x);
      const double top = between(bounded(upper[right - 1]), bounded(upper[right]), share).y - clip.y;
      const double bottom = between(bounded(lower[right - 1]), bounded(lower[right]), share).y - clip.y;
      const int last = std::min(clip.height, int(std::ceil(bottom)));
      for (int row = std::max(0, int(std::floor(top))); row < last; ++row)
        covered[row] += std::max(0.0, std::min(bottom, row + 1.0) - std::max(top, double(row))) / kSamples;
    }
    for (int row = 0; row < clip.height; ++row)
      mask.coverage[size_t(row) * clip.width + column] = byte_of(covered[row]);
  }
  return mask;
}

}  // namespace synpo
