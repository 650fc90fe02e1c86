#include "world/kitchen/kitchen_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/hash.h"
#include "helpers/kitchens.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(KitchenSet, NamesThings) {
  EXPECT_EQ(all_kitchens().name(), "kitchen");
  EXPECT_EQ(all_kitchens().envs(), 19);
  ASSERT_EQ(all_kitchens().task_count(), 21);
  EXPECT_EQ(all_kitchens().task_names()[0], "Container-Fridge");
  EXPECT_EQ(all_kitchens().task_names()[8], "Mug-Sink");
  EXPECT_EQ(all_kitchens().task_names()[20], "Bowl-Sink");
  EXPECT_EQ(all_kitchens().task_index("Apple-Microwave"), 16);
  EXPECT_EQ(all_kitchens().actions(), 7);
  EXPECT_EQ(all_kitchens().env_index("FloorPlan30"), 18);
}

TEST(KitchenSet, StartsAnywhereAlike) {
  const int env = all_kitchens().env_index("FloorPlan25");
  const KitchenTables& tables = all_kitchens().tables(env);
  constexpr int kStarts = 20000;
  std::map<int, int> poses, mugs;
  for (uint64_t i = 0; i < kStarts; ++i) {
    Random random(1, Purpose::kEpisodeStart, 0, i);
    const WorldState start = all_kitchens().reset(env, random);
    ASSERT_TRUE(all_kitchens().valid({env, 0}, start));
    const KitchenState state = unpack(start);
    ASSERT_EQ(tables.poses[state.pose].horizon, 0);
    ASSERT_EQ(state.doors, 0);
    ASSERT_EQ(state.hand, kEmptyHand);
    ++poses[state.pose];
    ++mugs[state.slots[2]];
  }
  for (const auto& [counts, kinds] : {std::pair{&poses, tables.start_poses.size()}, {&mugs, tables.slots.size()}}) {
    EXPECT_EQ(counts->size(), kinds);
    double chi_square = 0;
    const double expected = double(kStarts) / double(kinds);
    for (const auto& [value, count] : *counts) chi_square += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_square, double(kinds) + 5 * std::sqrt(2 * double(kinds)));
  }
}

TEST(KitchenSet, StartPlacesComeBack) {
  for (int i = 0; i < 400; ++i) {
    const int env = i % all_kitchens().envs();
    Random random(2, Purpose::kEpisodeStart, 0, uint64_t(i));
    const WorldState start = all_kitchens().reset(env, random);
    const StartPlaces places = all_kitchens().start_places(env, start);
    ASSERT_EQ(places.size(), 9u);
    ASSERT_EQ(all_kitchens().start_state(env, places), start);
    const KitchenPose& pose = all_kitchens().tables(env).poses[unpack(start).pose];
    ASSERT_EQ(places.at("agent"), std::pair(int(pose.row), int(pose.column)));
    ASSERT_EQ(places.at("view"), std::pair(int(pose.heading), 0));
    const KitchenCell& bowl = all_kitchens().tables(env).slots[unpack(start).slots[6]];
    ASSERT_EQ(places.at("Bowl"), std::pair(int(bowl.row), int(bowl.column)));
  }
}

TEST(KitchenSet, RefusesHostileStartPlaces) {
  const KitchenSet small({small_kitchen()});
  Random random(3, Purpose::kEpisodeStart, 0, 0);
  const StartPlaces good = small.start_places(0, small.reset(0, random));
  const auto error = [&](const std::string& name, std::pair<int, int> value) {
    StartPlaces places = good;
    places[name] = value;
    return message_of([&] { small.start_state(0, places); });
  };
  EXPECT_EQ(error("agent", {4, 4}), "no error");
  EXPECT_EQ(error("agent", {5, 3}), "'agent': found row 5, column 3, which is not a free cell");
  EXPECT_EQ(error("agent", {-1, 2000000000}), "'agent': found row -1, column 2000000000, which is not a free cell");
  EXPECT_EQ(error("agent", {4 + 65536, 4}), "'agent': found row 65540, column 4, which is not a free cell");
  EXPECT_EQ(error("view", {90, 30}), "'view': found heading 90, horizon 30, with which no episode starts");
  EXPECT_EQ(error("view", {45, 0}), "'view': found heading 45, horizon 0, with which no episode starts");
  EXPECT_EQ(error("view", {90 + 65536, 0}), "'view': found heading 65626, horizon 0, with which no episode starts");
  EXPECT_EQ(error("Plate", {4, 4}), "'Plate': found row 4, column 4, where no object can lie");
  EXPECT_EQ(error("Plate", good.at("Mug")), concat("'Plate': found row ", good.at("Mug").first, ", column ",
                                                   good.at("Mug").second, ", where another object lies"));
  EXPECT_EQ(error("Knife", {4, 4}), "found 'Knife', expected agent, view and the seven objects");
  for (const auto& [name, place] : good) {
    StartPlaces places = good;
    places.erase(name);
    EXPECT_EQ(message_of([&] { small.start_state(0, places); }), "'" + name + "': found none, expected two numbers");
  }
}

}  // namespace
}  // namespace synpo
