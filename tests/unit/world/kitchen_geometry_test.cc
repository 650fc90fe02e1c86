#include "world/kitchen/geometry/make_tables.h"

#include <gtest/gtest.h>

#include <cmath>

#include "helpers/kitchens.h"
#include "world/kitchen/builtin_kitchens.h"

namespace synpo {
namespace {

TEST(KitchenGeometry, MovesOnItsGrid) {
  const Kitchen kitchen = small_kitchen();
  const KitchenTables tables = kitchen_tables(kitchen, KitchenSolids(kitchen));
  ASSERT_EQ(tables.poses.size(), kitchen.floor.size() * 12);
  EXPECT_EQ(tables.start_poses.size(), kitchen.floor.size() * 4);
  for (const uint16_t start : tables.start_poses) EXPECT_EQ(tables.poses[start].horizon, 0);
  const auto leads = [&](int row, int column, int heading, int horizon, int move, int row2, int column2, int heading2,
                         int horizon2) {
    EXPECT_EQ(tables.next_pose(pose_at(tables, row, column, heading, horizon), move),
              pose_at(tables, row2, column2, heading2, horizon2));
  };
  leads(4, 4, 0, 30, kMoveAhead, 3, 4, 0, 30);
  leads(4, 4, 90, 0, kMoveAhead, 4, 5, 90, 0);
  leads(4, 5, 180, -30, kMoveAhead, 5, 5, 180, -30);
  leads(4, 4, 270, 0, kMoveAhead, 4, 3, 270, 0);
  leads(4, 4, 180, 0, kMoveAhead, 4, 4, 180, 0);  // the table
  leads(4, 7, 90, 0, kMoveAhead, 4, 7, 90, 0);    // a counter
  leads(5, 7, 90, 0, kMoveAhead, 5, 7, 90, 0);    // a wall
  leads(4, 4, 0, 30, kRotateLeft, 4, 4, 270, 30);
  leads(4, 4, 270, 30, kRotateRight, 4, 4, 0, 30);
  leads(4, 4, 0, 30, kLookUp, 4, 4, 0, 0);
  leads(4, 4, 0, 30, kLookDown, 4, 4, 0, 30);
  leads(4, 4, 0, -30, kLookUp, 4, 4, 0, -30);
}

// Whether a point lies in something solid that stands still, with walls moved out by `grow` cells.
bool solid(const Kitchen& kitchen, double x, double y, double z, double grow) {
  for (int row = std::max(0, int(y) - 1); row <= std::min(kitchen.rows - 1, int(y) + 1); ++row)
    for (int column = std::max(0, int(x) - 1); column <= std::min(kitchen.columns - 1, int(x) + 1); ++column) {
      if (x < column - grow || x > column + 1 + grow || y < row - grow || y > row + 1 + grow) continue;
      const char c = kitchen.at(row, column);
      if (c == '#' || (c == 'F' && z < 7.2 + grow) || ((c == 'c' || c == 'M') && z < 3.6 + grow)) return true;
      if (c == 'S' && z < 2.96 + grow) return true;
      if (c == 't' && z < 3 + grow && z > 2.76 - grow) return true;
      if (c != 'M') continue;
      const Kitchen::Footprint& foot = kitchen.receptacles[kMicrowave];
      const double gap = 0.12 - grow;
      if (z < 4.8 + grow && x > foot.column + gap && x < foot.column + foot.columns - gap && y > foot.row + gap &&
          y < foot.row + foot.rows - gap)
        return true;
    }
  return false;
}

// What the tables call visible, against a walk along the line of sight in small steps. Where a hair's breadth decides,
// either may be.
TEST(KitchenGeometry, SeesWhatNothingHides) {
  std::vector<Kitchen> kitchens = {small_kitchen()};
  for (const int i : {3, 14, 15, 16}) kitchens.push_back(builtin_kitchens()[size_t(i)]);
  int seen = 0, hidden = 0;
  for (const Kitchen& kitchen : kitchens) {
    const KitchenTables tables = kitchen_tables(kitchen, KitchenSolids(kitchen));
    for (int pose = 0; pose < tables.pose_count(); ++pose) {
      const KitchenPose& eye = tables.poses[size_t(pose)];
      for (size_t slot = 0; slot < tables.slots.size(); ++slot) {
        const KitchenCell& at = tables.slots[slot];
        const double dx = at.column - eye.column, dy = at.row - eye.row;
        const double height = (kitchen.at(at.row, at.column) == 't' ? 3 : 3.6) + 0.2, dz = height - 6;
        const double radians = eye.heading * M_PI / 180, pitch = eye.horizon * M_PI / 180;
        const double ahead = dx * std::sin(radians) - dy * std::cos(radians),
                     right = dx * std::cos(radians) + dy * std::sin(radians);
        const double depth = ahead * std::cos(pitch) - dz * std::sin(pitch),
                     up = ahead * std::sin(pitch) + dz * std::cos(pitch);
        const double edge = depth * std::tan(M_PI / 6);
        const bool in_view = std::abs(right) <= edge && std::abs(up) <= edge, near = dx * dx + dy * dy <= 36;
        bool free_thin = true, free_thick = true;
        for (int i = 0; in_view && near && free_thin && i < 1000; ++i) {
          const double t = i / 1000.0;
          free_thin &= !solid(kitchen, eye.column + 0.5 + t * dx, eye.row + 0.5 + t * dy, 6 + t * dz, -0.01);
          free_thick &= !solid(kitchen, eye.column + 0.5 + t * dx, eye.row + 0.5 + t * dy, 6 + t * dz, 0.01);
        }
        const auto list = tables.sight[0]->slots.at(pose);
        const auto found =
            std::find_if(list.begin(), list.end(), [&](const KitchenSeen& item) { return item.index == slot; });
        if (found != list.end()) {
          ++seen;
          ASSERT_TRUE(in_view && near && free_thin) << kitchen.name << " pose " << pose << " slot " << slot;
          ASSERT_EQ(int(found->distance), std::lround(250 * std::hypot(dx, dy)));
        } else {
          hidden += in_view && near;
          ASSERT_FALSE(in_view && near && free_thick) << kitchen.name << " pose " << pose << " slot " << slot;
        }
      }
      for (const KitchenSeenLists* lists : {&tables.sight[0]->slots, &tables.sight[0]->receptacles})
        ASSERT_TRUE(std::is_sorted(lists->at(pose).begin(), lists->at(pose).end(),
                                   [](const KitchenSeen& a, const KitchenSeen& b) {
                                     return std::pair(a.distance, a.index) < std::pair(b.distance, b.index);
                                   }));
    }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 50);
}

TEST(KitchenGeometry, EverySlotIsNearestFromSomewhere) {
  for (const Kitchen& kitchen : builtin_kitchens()) {
    const KitchenTables tables = kitchen_tables(kitchen, KitchenSolids(kitchen));
    std::vector<bool> nearest(tables.slots.size(), false);
    for (int pose = 0; pose < tables.pose_count(); ++pose) {
      const auto list = tables.sight[0]->slots.at(pose);
      if (!list.empty() && (list.size() == 1 || list[0].distance < list[1].distance)) nearest[list[0].index] = true;
    }
    EXPECT_EQ(std::count(nearest.begin(), nearest.end(), false), 0) << kitchen.name;
  }
}

}  // namespace
}  // namespace synpo
