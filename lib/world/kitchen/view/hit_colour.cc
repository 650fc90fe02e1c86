#include "world/kitchen/view/hit_colour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "world/kitchen/geometry/kitchen.h"

namespace synpo {
namespace {

constexpr float kFrame = in_cells(0.05f);  // around the inside of an open receptacle
constexpr float kBandTop = in_cells(1.4f);
constexpr float kPanelLow = in_cells(1.46f), kPanelHigh = in_cells(2.1f);
constexpr int kPanelCells = 3;  // from one picture on a wall to the next

bool faces_north_or_south(Face face) { return face == Face::kNorth || face == Face::kSouth; }

bool within(float value, float low, float high, float margin) { return value > low + margin && value < high - margin; }

// A place on an upright side of a footprint: cells along it from its left or upper end, and how many there are.
struct OnSide {
  float along, length;
};

OnSide on_side(const Kitchen::Footprint& foot, Face face, const Vec3& at) {
  if (faces_north_or_south(face)) return {at.x - float(foot.column), float(foot.columns)};
  return {at.y - float(foot.row), float(foot.rows)};
}

bool is_front(const Kitchen::Footprint& foot, Face face) { return int(face) == (foot.back + 2) % 4; }

Colour fridge(const Kitchen::Footprint& foot, bool open, Face face, const Vec3& at) {
  const Colour colour = kReceptacleColours[kFridge];
  if (face == Face::kTop) return colour;
  const OnSide side = on_side(foot, face, at);
  if (open) {
    if (!within(side.along, 0, side.length, kFrame) || !within(at.z, 0, kFridgeHeight, kFrame)) return colour;
    return std::fmod(at.z, in_cells(0.4f)) < in_cells(0.03f) ? kShelfColour : kInsideColour;
  }
  const float from_gap = std::fabs(at.z - in_cells(1.2f));  // between its two doors
  if (from_gap < in_cells(0.01f)) return mix(colour, 0.5f);
  const bool handle = is_front(foot, face) &&
                      std::fabs(side.along - side.length + in_cells(0.07f)) < in_cells(0.015f) &&
                      from_gap < in_cells(0.35f);
  return handle ? mix(colour, 1.25f) : colour;
}

// From close by only its top is seen, so that shows the door too.
Colour microwave(const Kitchen::Footprint& foot, bool open, Face face, const Vec3& at) {
  const Colour colour = kReceptacleColours[kMicrowave];
  if (face == Face::kTop) {
    const bool inner = within(at.x, float(foot.column), float(foot.column + foot.columns), 2 * kFrame) &&
                       within(at.y, float(foot.row), float(foot.row + foot.rows), 2 * kFrame);
    return open && inner ? kInsideColour : colour;
  }
  const OnSide side = on_side(foot, face, at);
  const bool inner = within(side.along, 0, side.length, 1.5f * kFrame) &&
                     within(at.z, kCounterHeight, kCounterHeight + kMicrowaveHeight, kFrame);
  if (open) return inner ? kInsideColour : colour;
  return is_front(foot, face) && inner && side.along < side.length * 0.7f ? mix(colour, 0.8f) : colour;
}

Colour cabinet(const KitchenPalette& palette, Face face, const Vec3& at) {
  if (at.z > kCounterHeight - in_cells(0.04f)) return palette.counter_top;
  if (at.z < in_cells(0.1f)) return mix(palette.cabinet, 0.55f);
  constexpr float kDoor = in_cells(0.5f), kGap = in_cells(0.012f);
  const float along = faces_north_or_south(face) ? at.x : at.y;
  const bool gap = along - kDoor * float(int(along / kDoor)) < kGap || std::fabs(at.z - in_cells(0.68f)) < kGap / 2;
  return gap ? mix(palette.cabinet, 0.7f) : palette.cabinet;
}

// Which picture hangs where is fixed by the place on the wall, so that walls can be told apart.
Colour wall(const KitchenPalette& palette, int cell, Face face, const Vec3& at) {
  if (at.z < kCounterHeight) return at.z < in_cells(0.1f) ? mix(palette.wall, 0.6f) : palette.wall;
  if (at.z < kBandTop) return palette.band;
  if (at.z < kPanelLow || at.z > kPanelHigh) return palette.wall;
  const bool along_row = faces_north_or_south(face);
  const int row = cell / kRayStride, column = cell % kRayStride;
  const int along = (along_row ? column : row) / kPanelCells, line = along_row ? row : column;
  const uint32_t mixed = uint32_t((along * kMaxKitchenSide + line) * 4 + int(face)) * 2654435761u;
  const Colour& panel = palette.panels[mixed >> 29];
  const float in_panel = (along_row ? at.x : at.y) - float(along * kPanelCells);
  if (!within(in_panel, 0, kPanelCells, 0.15f)) return palette.wall;
  return within(in_panel, 0, kPanelCells, 0.35f) && within(at.z, kPanelLow, kPanelHigh, 0.2f) ? panel
                                                                                              : mix(panel, 0.6f);
}

}  // namespace

Colour colour_of_hit(const SolidsView& view, int doors, const Hit& hit, const Vec3& direction, float length) {
  const KitchenSolids& solids = *view.solids;
  const KitchenPalette& palette = solids.palette;
  const Vec3 at = {view.eye_x + hit.t * direction.x, view.eye_y + hit.t * direction.y,
                   kEyeHeight + hit.t * direction.z};
  Colour colour = {};
  switch (hit.material) {
    case Material::kFloor:
      colour = palette.floor[size_t(hit.cell / kRayStride + hit.cell) % 2];
      if (solids.columns[size_t(hit.cell)].bottom > 0) colour = mix(colour, 0.6f);  // under a table
      break;
    case Material::kCeiling:
      colour = kCeilingColour;
      break;
    case Material::kWall:
      colour = wall(palette, hit.cell, hit.face, at);
      break;
    case Material::kCabinet:
      colour = cabinet(palette, hit.face, at);
      break;
    case Material::kCounterTop:
      colour = palette.counter_top;
      break;
    case Material::kTable:
      colour = palette.table;
      break;
    case Material::kFridge:
      colour = fridge(solids.receptacles[kFridge], doors >> kFridge & 1, hit.face, at);
      break;
    case Material::kMicrowave:
      colour = microwave(solids.receptacles[kMicrowave], doors >> kMicrowave & 1, hit.face, at);
      break;
    case Material::kSink:
      colour = mix(kReceptacleColours[kSink], at.z < kCounterHeight - in_cells(0.1f) ? 0.7f : 1.0f);
      break;
    case Material::kObject:
      colour = kObjectColours[hit.object][0];
      break;
    case Material::kObjectTrim:
      colour = kObjectColours[hit.object][1];
      break;
  }
  static constexpr float by_face[] = {0.86f, 0.74f, 0.86f, 0.74f, 1.0f, 0.95f};
  return mix(colour, by_face[size_t(hit.face)] * std::max(0.55f, 1 - 0.07f * kCellMetres * hit.t * length));
}

}  // namespace synpo
