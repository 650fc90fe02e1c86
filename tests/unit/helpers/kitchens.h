// Kitchens for tests.
#pragma once
#include <algorithm>

#include "world/kitchen/geometry/make_tables.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/rules.h"

namespace synpo {

// One with everything in it.
inline const char* const kSmallPlan =
    "##########\n"
    "#cFFcSSSc#\n"
    "#cFFcSSSc#\n"
    "#.......c#\n"
    "#.......c#\n"
    "#..tt...##\n"
    "#..tt...##\n"
    "#.......c#\n"
    "#ccMMcccc#\n"
    "#ccMMcccc#\n"
    "##########\n";

inline Kitchen small_kitchen() { return parse_kitchen("small", kSmallPlan, "small.txt"); }

// All that are built in.
inline const KitchenSet& all_kitchens() {
  static const KitchenSet kitchens;
  return kitchens;
}

// Position of a pose, or -1.
inline int pose_at(const KitchenTables& tables, int row, int column, int heading, int horizon) {
  const KitchenPose pose = {int16_t(row), int16_t(column), int16_t(heading), int16_t(horizon)};
  const auto found = std::find(tables.poses.begin(), tables.poses.end(), pose);
  return found == tables.poses.end() ? -1 : int(found - tables.poses.begin());
}

inline KitchenSeenLists seen_lists(const std::vector<std::vector<KitchenSeen>>& lists) {
  KitchenSeenLists all;
  for (const auto& list : lists) {
    all.items.insert(all.items.end(), list.begin(), list.end());
    all.begin.push_back(uint32_t(all.items.size()));
  }
  return all;
}

// Five poses in a ring that rotating right walks along and rotating left back; nothing else moves. From pose 0 nothing
// is in sight, from 1 slots 2 and 1, equally near, and farther off 0; from 2 the Sink and farther off the Fridge; from
// 3 the Fridge, the Microwave farther off and slot 3; from 4 the Microwave.
inline KitchenTables ring_tables() {
  KitchenTables tables;
  for (int16_t i = 0; i < 5; ++i) {
    tables.poses.push_back({1, i, 0, 0});
    tables.start_poses.push_back(uint16_t(i));
    for (const int to : {int(i), (i + 4) % 5, (i + 1) % 5, int(i), int(i)}) tables.next.push_back(uint16_t(to));
  }
  for (int16_t i = 0; i < 10; ++i) tables.slots.push_back({2, i});
  auto sight = std::make_shared<KitchenSight>();
  sight->slots = seen_lists({{}, {{100, 1}, {100, 2}, {200, 0}}, {}, {{900, 3}}, {}});
  sight->receptacles =
      seen_lists({{}, {}, {{500, kSink}, {700, kFridge}}, {{300, kFridge}, {400, kMicrowave}}, {{100, kMicrowave}}});
  tables.sight.fill(sight);
  return tables;
}

}  // namespace synpo
