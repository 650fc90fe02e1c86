#include "draw/plot/labels.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace synpo {
namespace {

int64_t overlap(const Box& a, const Box& b) {
  const int width = std::min(a.right(), b.right()) - std::max(a.x, b.x),
            height = std::min(a.bottom(), b.bottom()) - std::max(a.y, b.y);
  return width > 0 && height > 0 ? int64_t{width} * height : 0;
}

// Beside the marker, above and below it, at its corners; nearer ones before those a little away.
std::vector<Box> candidates(const Box& marker, int width, int height) {
  std::vector<Box> out;
  for (const int gap : {height / 5, height}) {
    const int left = marker.x - gap - width, right = marker.right() + gap, above = marker.y - gap - height,
              below = marker.bottom() + gap;
    const int middle_x = marker.x + (marker.width - width) / 2, middle_y = marker.y + (marker.height - height) / 2;
    for (const auto& [x, y] : {std::pair{right, middle_y},
                               {left, middle_y},
                               {middle_x, above},
                               {middle_x, below},
                               {right, above},
                               {left, above},
                               {right, below},
                               {left, below}})
      out.push_back({x, y, width, height});
  }
  return out;
}

}  // namespace

std::vector<Box> place_labels(const std::vector<LabelledPoint>& points, int size, const Box& plot, const Font& font) {
  std::vector<Box> taken, out;
  for (const LabelledPoint& point : points) taken.push_back(point.marker);
  for (const LabelledPoint& point : points) {
    const int width = font.width(point.name, size) + size / 4, height = font.digit_height(size) + size / 4;
    Box best{};
    int64_t least = INT64_MAX;
    for (const Box& box : candidates(point.marker, width, height)) {
      int64_t covered = 0;
      for (const Box& other : taken) covered += overlap(box, other);
      covered += 4 * (int64_t{width} * height - overlap(box, plot));
      if (covered >= least) continue;
      least = covered;
      best = box;
    }
    best.x = std::clamp(best.x, plot.x, std::max(plot.x, plot.right() - width));
    best.y = std::clamp(best.y, plot.y, std::max(plot.y, plot.bottom() - height));
    taken.push_back(best);
    out.push_back(best);
  }
  return out;
}

}  // namespace synpo
