#include "world/kitchen/geometry/ray.h"

#include <algorithm>
#include <limits>

#include "world/kitchen/geometry/shapes.h"

namespace synpo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kSlack = 1e-4f;  // of t, for boxes that touch the border of a cell

constexpr float kTableUnderside = in_cells(0.69f);
constexpr float kTableLeg = in_cells(0.05f);
constexpr float kBasinFloor = in_cells(0.74f);
constexpr float kBasinRim = in_cells(0.035f);
constexpr float kMicrowaveGap = in_cells(0.03f);

// Where the ray meets a box from outside, not before `from` nor after `to`.
bool hit_box(const Vec3& low, const Vec3& high, const Vec3& eye, const Vec3& d, float from, float to, float& t,
             Face& face) {
  float enter = -kInfinity, leave = kInfinity;
  const auto slab = [&](float low_side, float high_side, float origin, float step, Face low_face, Face high_face) {
    if (step == 0) {
      if (origin < low_side || origin > high_side) leave = -kInfinity;
      return;
    }
    const float near = ((step > 0 ? low_side : high_side) - origin) / step,
                far = ((step > 0 ? high_side : low_side) - origin) / step;
    if (near > enter) {
      enter = near;
      face = step > 0 ? low_face : high_face;
    }
    leave = std::min(leave, far);
  };
  slab(low.x, high.x, eye.x, d.x, Face::kWest, Face::kEast);
  slab(low.y, high.y, eye.y, d.y, Face::kNorth, Face::kSouth);
  slab(low.z, high.z, eye.z, d.z, Face::kBottom, Face::kTop);
  if (enter > leave || enter < from - kSlack || enter > to + kSlack) return false;
  t = enter;
  return true;
}

KitchenSolids::Column column_of(char c) {
  switch (c) {
    case '.':
      return {};
    case 't':
      return {.bottom = kTableUnderside, .top = kTableHeight, .side = Material::kTable, .cover = Material::kTable};
    case 'F':
      return {.top = kFridgeHeight, .side = Material::kFridge, .cover = Material::kFridge};
    case 'S':
      return {.top = kBasinFloor, .side = Material::kCabinet, .cover = Material::kSink};
    case '#':
      return {.top = kInfinity, .side = Material::kWall, .cover = Material::kWall};
    default:
      return {.top = kCounterHeight, .side = Material::kCabinet, .cover = Material::kCounterTop};
  }
}

// A box in the frame of a footprint: `along` its back from the middle, `out` of the back, heights above the floor.
SolidBox placed(const Kitchen::Footprint& foot, float along_low, float along_high, float out_low, float out_high,
                float z_low, float z_high, Material material) {
  const float top = float(foot.row), left = float(foot.column), bottom = top + float(foot.rows),
              right = left + float(foot.columns);
  const float middle_x = (left + right) / 2, middle_y = (top + bottom) / 2;
  switch (foot.back) {
    case 0:
      return {{middle_x + along_low, top + out_low, z_low}, {middle_x + along_high, top + out_high, z_high}, material};
    case 1:
      return {
          {right - out_high, middle_y + along_low, z_low}, {right - out_low, middle_y + along_high, z_high}, material};
    case 2:
      return {{middle_x + along_low, bottom - out_high, z_low},
              {middle_x + along_high, bottom - out_low, z_high},
              material};
    default:
      return {
          {left + out_low, middle_y + along_low, z_low}, {left + out_high, middle_y + along_high, z_high}, material};
  }
}

void add_microwave(const Kitchen::Footprint& foot, std::vector<SolidBox>& boxes) {
  const float row = float(foot.row), column = float(foot.column);
  boxes.push_back({{column + kMicrowaveGap, row + kMicrowaveGap, kCounterHeight},
                   {column + float(foot.columns) - kMicrowaveGap, row + float(foot.rows) - kMicrowaveGap,
                    kCounterHeight + kMicrowaveHeight},
                   Material::kMicrowave});
}

// Rim, tap and spout above the basin.
void add_sink(const Kitchen::Footprint& foot, std::vector<SolidBox>& boxes) {
  const bool sideways = foot.back % 2;
  const float half = float(sideways ? foot.rows : foot.columns) / 2, depth = float(sideways ? foot.columns : foot.rows);
  const auto add = [&](float along_low, float along_high, float out_low, float out_high, float z_low, float z_high) {
    boxes.push_back(placed(foot, along_low, along_high, out_low, out_high, z_low, z_high, Material::kSink));
  };
  add(-half, -half + kBasinRim, 0, depth, kBasinFloor, kCounterHeight);
  add(half - kBasinRim, half, 0, depth, kBasinFloor, kCounterHeight);
  add(-half, half, 0, kBasinRim, kBasinFloor, kCounterHeight);
  add(-half, half, depth - kBasinRim, depth, kBasinFloor, kCounterHeight);
  const float thick = in_cells(0.015f), spout = kCounterHeight + in_cells(0.22f);
  add(-thick, thick, thick, 3 * thick, kCounterHeight, spout + thick);
  add(-thick, thick, 3 * thick, in_cells(0.14f), spout - thick, spout + thick);
}

// A leg where two sides of a table meet.
void add_legs(const Kitchen& kitchen, int row, int column, std::vector<SolidBox>& boxes) {
  for (int side = 0; side < 4; ++side) {
    const int next = (side + 1) % 4;
    if (kitchen.at(row + kRowStep[side], column + kColumnStep[side]) == 't' ||
        kitchen.at(row + kRowStep[next], column + kColumnStep[next]) == 't')
      continue;
    const float x = float(column) + (kColumnStep[side] + kColumnStep[next] > 0 ? 1 - kTableLeg : 0);
    const float y = float(row) + (kRowStep[side] + kRowStep[next] > 0 ? 1 - kTableLeg : 0);
    boxes.push_back({{x, y, 0}, {x + kTableLeg, y + kTableLeg, kTableUnderside}, Material::kTable});
  }
}

}  // namespace

KitchenSolids::KitchenSolids(const Kitchen& kitchen)
    : columns(kRayCells), reach(kRayCells, 0.0f), receptacles(kitchen.receptacles), hash(kitchen.hash),
      palette(kitchen.hash), cells(kitchen.rows * kRayStride) {
  std::vector<SolidBox> all;
  add_microwave(receptacles[kMicrowave], all);
  add_sink(receptacles[kSink], all);
  for (int row = 0; row < kitchen.rows; ++row)
    for (int column = 0; column < kitchen.columns; ++column)
      if (kitchen.at(row, column) == 't') add_legs(kitchen, row, column, all);
  for (int row = 0; row < kitchen.rows; ++row)
    for (int column = 0; column < kitchen.columns; ++column) {
      const int cell = ray_cell(row, column);
      Column& solid = columns[size_t(cell)];
      solid = column_of(kitchen.at(row, column));
      solid.first_box = uint16_t(boxes.size());
      reach[size_t(cell)] = solid.top;
      for (const SolidBox& box : all) {
        if (box.high.x <= float(column) || box.low.x >= float(column + 1) || box.high.y <= float(row) ||
            box.low.y >= float(row + 1))
          continue;
        boxes.push_back(box);
        reach[size_t(cell)] = std::max(reach[size_t(cell)], box.high.z);
      }
      solid.boxes = uint16_t(boxes.size() - solid.first_box);
    }
}

Camera::Camera(int heading, int horizon) {
  const float cosine = horizon == 0 ? 1.0f : 0.86602540378f, sine = horizon == 0 ? 0.0f : horizon > 0 ? 0.5f : -0.5f;
  const float x = float(kColumnStep[heading]), y = float(kRowStep[heading]);
  right = {-y, x, 0};
  forward = {x * cosine, y * cosine, -sine};
  up = {x * sine, y * sine, cosine};
}

bool Camera::sees(const Vec3& offset) const {
  const auto along = [&](const Vec3& axis) { return offset.x * axis.x + offset.y * axis.y + offset.z * axis.z; };
  const float reach = along(forward) * kViewSlope;
  return reach > 0 && std::fabs(along(right)) <= reach && std::fabs(along(up)) <= reach;
}

void hit_boxes(const SolidsView& view, const Vec3& direction, int cell, float t_in, float t_out, Hit& hit) {
  const KitchenSolids::Column& solid = view.solids->columns[size_t(cell)];
  const Vec3 eye = {view.eye_x, view.eye_y, kEyeHeight};
  float t;
  Face face;
  for (int i = 0; i < solid.boxes; ++i) {
    const SolidBox& box = view.solids->boxes[size_t(solid.first_box + i)];
    if (hit_box(box.low, box.high, eye, direction, t_in, t_out, t, face) && t < hit.t)
      hit = {t, cell, box.material, face, kNoObject};
  }
  const uint8_t object = view.occupants ? view.occupants[cell] : kNoObject;
  if (object == kNoObject) return;
  const Vec3 above = {eye.x - float(cell % kRayStride) - 0.5f, eye.y - float(cell / kRayStride) - 0.5f,
                      eye.z - solid.top};
  for (const ObjectPart& part : object_parts(object))
    if (hit_box(part.low, part.high, above, direction, t_in, t_out, t, face) && t < hit.t)
      hit = {t, cell, part.trim ? Material::kObjectTrim : Material::kObject, face, object};
}

Hit trace(const SolidsView& view, int cell, const Vec3& direction) {
  Hit hit;
  for (RayWalk walk(cell, direction);; walk.next()) {
    const bool may_hit = lowest(direction.z, walk.t_in, walk.t_out) < view.reach[walk.cell] ||
                         kEyeHeight + direction.z * walk.t_out >= kRoomHeight;
    if (may_hit && hit_in_cell(view, direction, walk.cell, walk.t_in, walk.t_out, walk.face, hit)) return hit;
  }
}

}  // namespace synpo
