// The room of a kitchen as solids on its grid, and the one ray that both draws it and decides what is visible.
//
// All lengths are in cells of 0.25 m: x is the column, y the row (south), z the height. A ray starts at the eye, above
// the middle of a floor cell, and visits the cells on its way one by one.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/palette.h"

namespace synpo {

constexpr float in_cells(float metres) { return metres / kCellMetres; }
constexpr float kEyeHeight = in_cells(1.5f);
constexpr float kRoomHeight = in_cells(2.5f);
constexpr float kCounterHeight = in_cells(0.9f);
constexpr float kTableHeight = in_cells(0.75f);
constexpr float kFridgeHeight = in_cells(1.8f);
constexpr float kMicrowaveHeight = in_cells(0.3f);  // on a counter

struct Vec3 {
  float x, y, z;
};

// Cells are numbered with the same stride in every kitchen, so that the way of a ray can be stored.
constexpr int kRayStride = 64;
constexpr int kRayCells = kMaxKitchenSide * kRayStride;
constexpr int ray_cell(int row, int column) { return row * kRayStride + column; }
constexpr uint8_t kNoObject = 255;

enum class Material : uint8_t {
  kFloor,
  kCeiling,
  kWall,
  kCabinet,
  kCounterTop,
  kTable,
  kFridge,
  kMicrowave,
  kSink,
  kObject,
  kObjectTrim
};
// The side of a solid that a ray meets; the first four are also headings in quarter turns.
enum class Face : uint8_t { kNorth, kEast, kSouth, kWest, kTop, kBottom };

struct SolidBox {
  Vec3 low, high;
  Material material;
};

struct Hit {
  float t;  // in lengths of the ray's direction
  int cell;
  Material material;
  Face face;
  uint8_t object;  // for an object's materials
};

// All that stands still: one column of solid a cell, [bottom, top) of it filled, and boxes.
struct KitchenSolids {
  explicit KitchenSolids(const Kitchen& kitchen);

  struct Column {
    float bottom = 0, top = 0;
    Material side = Material::kFloor, cover = Material::kFloor;
    uint16_t first_box = 0, boxes = 0;  // in `boxes`
  };
  std::vector<Column> columns;  // [kRayCells]
  std::vector<float> reach;     // [kRayCells]: no ray above it meets anything in the cell
  std::vector<SolidBox> boxes;
  std::array<Kitchen::Footprint, kKitchenReceptacles> receptacles;
  uint64_t hash;  // the kitchen's
  KitchenPalette palette;
  int cells;  // of the rows in use: columns and reach matter that far
};

// The solids with objects among them, seen from one place.
struct SolidsView {
  const KitchenSolids* solids;
  float eye_x, eye_y;
  const float* reach;        // as in the solids, objects included
  const uint8_t* occupants;  // [kRayCells]: the object in a cell, or kNoObject; null for none anywhere
};

// Tallest object, and the middle of an object above what it lies on (for all the same, so that a slot is visible
// whatever lies on it).
constexpr float kObjectReach = in_cells(0.2f);
constexpr float kObjectMiddle = in_cells(0.05f);

// The axes of a view: heading in quarter turns from north, horizon one of -30, 0, 30 degrees.
struct Camera {
  Camera(int heading, int horizon);
  Vec3 right, up, forward;  // unit length
  // Whether a point, given from the eye, lies in the field of view of 60 degrees.
  bool sees(const Vec3& offset) const;
};
constexpr float kViewSlope = 0.57735026919f;  // half the field of view: tan 30 degrees

// The cells that a ray visits. Crossings are computed by division, so that those of a corner are equal exactly; there
// the ray goes by column first.
struct RayWalk {
  RayWalk(int from, const Vec3& direction)
      : cell(from), step_x(direction.x > 0 ? 1 : -1), step_y(direction.y > 0 ? kRayStride : -kRayStride),
        face_x(direction.x > 0 ? Face::kWest : Face::kEast), face_y(direction.y > 0 ? Face::kNorth : Face::kSouth),
        length_x(std::fabs(direction.x)), length_y(std::fabs(direction.y)), cross_x(0.5f / length_x),
        cross_y(0.5f / length_y), t_out(cross_x < cross_y ? cross_x : cross_y) {}
  void next() {
    t_in = t_out;
    if (cross_x <= cross_y) {
      cell += step_x;
      face = face_x;
      cross_x = (count_x += 1) / length_x;
    } else {
      cell += step_y;
      face = face_y;
      cross_y = (count_y += 1) / length_y;
    }
    t_out = cross_x < cross_y ? cross_x : cross_y;
  }
  int cell, step_x, step_y;
  Face face = Face::kTop, face_x, face_y;  // by which the ray came into the cell
  float length_x, length_y, count_x = 0.5f, count_y = 0.5f, cross_x, cross_y;
  float t_in = 0, t_out;
};

// Lowest height of a ray within a cell.
inline float lowest(float dz, float t_in, float t_out) { return kEyeHeight + dz * (dz < 0 ? t_out : t_in); }

// Puts into `hit` what of a cell's boxes and object a ray meets before it.
void hit_boxes(const SolidsView& view, const Vec3& direction, int cell, float t_in, float t_out, Hit& hit);

// The first thing that a ray from the eye meets in one cell of its way; false for nothing.
inline bool hit_in_cell(const SolidsView& view, const Vec3& direction, int cell, float t_in, float t_out, Face entered,
                        Hit& hit) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const KitchenSolids::Column& solid = view.solids->columns[size_t(cell)];
  const float z_in = kEyeHeight + t_in * direction.z, z_out = kEyeHeight + t_out * direction.z;
  hit = {kNone, cell, Material::kFloor, Face::kTop, kNoObject};
  if (z_in >= solid.top) {
    if (z_out < solid.top) {
      hit.t = (solid.top - kEyeHeight) / direction.z;
      hit.material = solid.cover;
    }
  } else if (z_in >= solid.bottom) {
    hit.t = t_in;
    hit.material = solid.side;
    hit.face = entered;
    return true;
  } else if (z_out < 0) {
    hit.t = -kEyeHeight / direction.z;
  }
  if (solid.boxes || (view.occupants && view.occupants[cell] != kNoObject))
    hit_boxes(view, direction, cell, t_in, t_out, hit);
  if (hit.t == kNone && z_out >= kRoomHeight)
    hit = {(kRoomHeight - kEyeHeight) / direction.z, cell, Material::kCeiling, Face::kBottom, kNoObject};
  return hit.t != kNone;
}

// The first thing that a ray from the eye above `cell` meets; walls, floor and ceiling let none pass.
Hit trace(const SolidsView& view, int cell, const Vec3& direction);

}  // namespace synpo
