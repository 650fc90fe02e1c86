#include "world/kitchen/geometry/make_tables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include "base/error.h"

namespace synpo {
namespace {

constexpr int kHeadings = 4, kHorizons = 3, kLevel = 1;
constexpr int kHorizonDegrees = 30;

int pose_of(int cell, int heading, int horizon) { return (cell * kHeadings + heading) * kHorizons + horizon; }

// The middle of a thing; x and y in half cells, so that distances are exact.
struct Target {
  int x2, y2;
  float height;
  Material material;  // what the ray may end on; kObject: nothing at all
};

// The distance in half cells from the middle of a floor cell, squared.
int squared(const KitchenCell& from, const Target& target) {
  const int dx = target.x2 - 2 * from.column - 1, dy = target.y2 - 2 * from.row - 1;
  return dx * dx + dy * dy;
}

Vec3 offset(const KitchenCell& from, const Target& target) {
  return {float(target.x2 - 2 * from.column - 1) / 2, float(target.y2 - 2 * from.row - 1) / 2,
          target.height - kEyeHeight};
}

bool clear_ray(const KitchenSolids& solids, const KitchenCell& from, const Target& target) {
  const SolidsView view = {&solids, float(from.column) + 0.5f, float(from.row) + 0.5f, solids.reach.data(), nullptr};
  const Hit hit = trace(view, ray_cell(from.row, from.column), offset(from, target));
  return hit.t >= 1 || (target.material != Material::kObject && hit.material == target.material);
}

struct Near {
  int squared;  // distance in half cells
  int target;
  Vec3 offset;
};

// Calls use(near) for every pose in order, with what of the targets is in sight, nearest first and then by index.
template <class Use>
void for_every_pose(const Kitchen& kitchen, const KitchenSolids& solids, const std::vector<Target>& targets,
                    Use&& use) {
  std::vector<Near> around, seen;
  for (const KitchenCell& from : kitchen.floor) {
    around.clear();
    for (size_t i = 0; i < targets.size(); ++i) {
      const int distance = squared(from, targets[i]);
      if (distance <= 4 * kSightCells * kSightCells && clear_ray(solids, from, targets[i]))
        around.push_back({distance, int(i), offset(from, targets[i])});
    }
    std::stable_sort(around.begin(), around.end(), [](const Near& a, const Near& b) { return a.squared < b.squared; });
    for (int heading = 0; heading < kHeadings; ++heading)
      for (int horizon = 0; horizon < kHorizons; ++horizon) {
        const Camera camera(heading, (horizon - kLevel) * kHorizonDegrees);
        seen.clear();
        std::copy_if(around.begin(), around.end(), std::back_inserter(seen),
                     [&](const Near& near) { return camera.sees(near.offset); });
        use(seen);
      }
  }
}

KitchenSeenLists seen_lists(const Kitchen& kitchen, const KitchenSolids& solids, const std::vector<Target>& targets) {
  KitchenSeenLists lists;
  for_every_pose(kitchen, solids, targets, [&](const std::vector<Near>& seen) {
    for (const Near& near : seen)
      lists.items.push_back(
          {uint16_t(std::lround(std::sqrt(double(near.squared)) * 500 * double(kCellMetres))), uint8_t(near.target)});
    lists.begin.push_back(uint32_t(lists.items.size()));
  });
  return lists;
}

std::vector<Target> slot_targets(const Kitchen& kitchen, const std::vector<KitchenCell>& slots) {
  std::vector<Target> targets;
  for (const KitchenCell& slot : slots) {
    const float top = kitchen.at(slot.row, slot.column) == 't' ? kTableHeight : kCounterHeight;
    targets.push_back({2 * slot.column + 1, 2 * slot.row + 1, top + kObjectMiddle, Material::kObject});
  }
  return targets;
}

std::vector<Target> receptacle_targets(const Kitchen& kitchen) {
  static constexpr float heights[kKitchenReceptacles] = {kFridgeHeight / 2, kCounterHeight + kMicrowaveHeight / 2,
                                                         kCounterHeight};
  static constexpr Material materials[kKitchenReceptacles] = {Material::kFridge, Material::kMicrowave, Material::kSink};
  std::vector<Target> targets;
  for (size_t i = 0; i < kKitchenReceptacles; ++i) {
    const Kitchen::Footprint& foot = kitchen.receptacles[i];
    targets.push_back({2 * foot.column + foot.columns, 2 * foot.row + foot.rows, heights[i], materials[i]});
  }
  return targets;
}

// Cells that are nearer than all others from somewhere, thinned out evenly where they are too many.
std::vector<KitchenCell> choose_slots(const Kitchen& kitchen, const KitchenSolids& solids) {
  std::vector<KitchenCell> cells;
  for (int row = 0; row < kitchen.rows; ++row)
    for (int column = 0; column < kitchen.columns; ++column)
      if (kitchen.at(row, column) == 'c' || kitchen.at(row, column) == 't')
        cells.push_back({int16_t(row), int16_t(column)});
  std::vector<bool> nearest(cells.size(), false);
  for_every_pose(kitchen, solids, slot_targets(kitchen, cells), [&](const std::vector<Near>& seen) {
    if (!seen.empty() && (seen.size() == 1 || seen[0].squared < seen[1].squared))
      nearest[size_t(seen[0].target)] = true;
  });
  std::vector<KitchenCell> good, slots;
  for (size_t i = 0; i < cells.size(); ++i)
    if (nearest[i]) good.push_back(cells[i]);
  const size_t count = std::min<size_t>(good.size(), kMaxKitchenSlots);
  for (size_t i = 0; i < count; ++i) slots.push_back(good[i * good.size() / count]);
  return slots;
}

}  // namespace

KitchenTables kitchen_tables(const Kitchen& kitchen, const KitchenSolids& solids) {
  KitchenTables tables;
  const int cells = int(kitchen.floor.size());
  std::vector<int> floor_index(kRayCells, -1);
  for (int i = 0; i < cells; ++i)
    floor_index[size_t(ray_cell(kitchen.floor[size_t(i)].row, kitchen.floor[size_t(i)].column))] = i;
  for (int i = 0; i < cells; ++i) {
    const KitchenCell& at = kitchen.floor[size_t(i)];
    for (int heading = 0; heading < kHeadings; ++heading) {
      const int ahead = floor_index[size_t(ray_cell(at.row + kRowStep[heading], at.column + kColumnStep[heading]))];
      for (int horizon = 0; horizon < kHorizons; ++horizon) {
        if (horizon == kLevel) tables.start_poses.push_back(uint16_t(tables.poses.size()));
        tables.poses.push_back(
            {at.row, at.column, int16_t(heading * 90), int16_t((horizon - kLevel) * kHorizonDegrees)});
        const int moves[kKitchenMoves] = {
            pose_of(ahead < 0 ? i : ahead, heading, horizon), pose_of(i, (heading + 3) % kHeadings, horizon),
            pose_of(i, (heading + 1) % kHeadings, horizon), pose_of(i, heading, std::max(horizon - 1, 0)),
            pose_of(i, heading, std::min(horizon + 1, kHorizons - 1))};
        for (const int to : moves) tables.next.push_back(uint16_t(to));
      }
    }
  }
  tables.slots = choose_slots(kitchen, solids);
  if (int(tables.slots.size()) < kKitchenObjects)
    fail(Exit::kData, kitchen.name, ": found ", tables.slots.size(),
         " places on which an object can lie and be picked up, expected at least ", kKitchenObjects);
  auto sight = std::make_shared<KitchenSight>();
  sight->slots = seen_lists(kitchen, solids, slot_targets(kitchen, tables.slots));
  sight->receptacles = seen_lists(kitchen, solids, receptacle_targets(kitchen));
  tables.sight.fill(sight);
  return tables;
}

}  // namespace synpo
