#include "draw/kitchen/kitchen_moment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "base/rgb.h"
#include "draw/kitchen/kitchen_picture.h"
#include "world/kitchen/geometry/make_tables.h"

namespace synpo {
namespace {

constexpr Rgb kSight = {0, 150, 160};
constexpr double kSightOpacity = 0.3;
constexpr double kHalfSight = std::numbers::pi / 6;
constexpr double kObjectShare = 1.08;  // of a cell

// How far a view along (x, y), of length 1, reaches, in cells.
double reach(const Kitchen& kitchen, const KitchenPose& eye, double x, double y) {
  constexpr double kPace = 0.02;
  bool in_fridge = false;
  for (double length = 0; length < kSightCells; length += kPace) {
    const char c =
        kitchen.at(int(std::floor(eye.row + 0.5 + length * y)), int(std::floor(eye.column + 0.5 + length * x)));
    if (c == '#' || (in_fridge && c != 'F')) return length;
    in_fridge = c == 'F';
  }
  return kSightCells;
}

}  // namespace

void draw_sight(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& eye) {
  constexpr int kRays = 360;
  const Point from = place.centre(plan_cell(kitchen, eye.row, eye.column));
  std::vector<Point> corners = {from};
  for (int i = 0; i <= kRays; ++i) {
    const double angle = eye.heading * std::numbers::pi / 180 + kHalfSight * (2.0 * i / kRays - 1);
    const double x = std::sin(angle), y = -std::cos(angle), length = reach(kitchen, eye, x, y) * place.cell;
    corners.push_back({from.x + length * x, from.y + length * y});
  }
  canvas.polygon(corners, kSight, kSightOpacity);
}

void draw_sight_sign(Canvas& canvas, const Box& box) {
  const Rgb shade = {uint8_t(255 - (255 - kSight.r) * 0.45), uint8_t(255 - (255 - kSight.g) * 0.45),
                     uint8_t(255 - (255 - kSight.b) * 0.45)};
  const double top = box.y + 0.06 * box.height;
  canvas.polygon({{box.x + box.width / 2.0, double(box.bottom())}, {double(box.x), top}, {double(box.right()), top}},
                 shade);
}

Box object_box(const PlanGrid& place, int cell) {
  const Point centre = place.centre(cell);
  const int side = int(std::lround(place.cell * kObjectShare));
  return {int(std::lround(centre.x - side / 2.0)), int(std::lround(centre.y - side / 2.0)), side, side};
}

Box agent_box(const PlanGrid& place, const Kitchen& kitchen, const KitchenPose& pose) {
  return object_box(place, plan_cell(kitchen, pose.row, pose.column));
}

void draw_objects(Canvas& canvas, const PlanGrid& place, const Kitchen& kitchen, const KitchenFrame& frame,
                  int wanted) {
  const auto box_of = [&](int object) {
    const int cell = frame.objects[size_t(object)];
    return object_box(place, plan_cell(kitchen, cell / kRayStride, cell % kRayStride));
  };
  if (frame.objects[size_t(wanted)] >= 0) draw_wanted(canvas, box_of(wanted), wanted);
  for (int i = 0; i < kKitchenObjects; ++i)
    if (frame.objects[size_t(i)] >= 0) draw_object(canvas, box_of(i), i);
}

void draw_kitchen_seen(Canvas& canvas, const Box& box, const KitchenSolids& solids, const KitchenFrame& frame) {
  constexpr int kFine = 2;  // rays a pixel, each way
  const int width = kFine * box.width;
  std::vector<uint8_t> fine(size_t(width) * size_t(kFine * box.height) * 3), rgb;
  render(solids, frame, width, kFine * box.height, fine.data());
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int i = 0; i < kFine * kFine; ++i)
          sum += fine[(size_t(y * kFine + i / kFine) * size_t(width) + size_t(x * kFine + i % kFine)) * 3 +
                      size_t(channel)];
        rgb.push_back(uint8_t((sum + kFine * kFine / 2) / (kFine * kFine)));
      }
  canvas.picture(box, std::move(rgb));
}

void draw_small_seen(Canvas& canvas, const Box& box, const KitchenSolids& solids, const KitchenFrame* frame) {
  std::array<uint8_t, kSmallView* kSmallView* 3> rgb = {};
  if (frame) render_small(solids, *frame, rgb.data());
  std::vector<Rgb> colours;
  for (size_t at = 0; at < rgb.size(); at += 3) colours.push_back({rgb[at], rgb[at + 1], rgb[at + 2]});
  canvas.squares(box.x, box.y, box.width / kSmallView, kSmallView, colours);
}

}  // namespace synpo
