#include "world/kitchen/builtin_kitchens.h"

#include <gtest/gtest.h>

#include <set>

#include "base/hash.h"
#include "helpers/kitchens.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

const std::pair<int, int> kTable1[] = {{1, 129}, {2, 115}, {3, 104}, {4, 69},   {5, 99},  {6, 134},  {8, 172},
                                       {9, 76},  {11, 67}, {12, 79}, {18, 222}, {20, 80}, {22, 136}, {23, 96},
                                       {24, 61}, {25, 27}, {27, 43}, {28, 101}, {30, 59}};

TEST(BuiltinKitchens, AreThoseOfTable1) {
  const std::vector<Kitchen>& kitchens = builtin_kitchens();
  ASSERT_EQ(kitchens.size(), std::size(kTable1));
  std::set<uint64_t> hashes;
  for (size_t i = 0; i < kitchens.size(); ++i) {
    EXPECT_EQ(kitchens[i].name, "FloorPlan" + std::to_string(kTable1[i].first));
    EXPECT_EQ(int(kitchens[i].floor.size()), kTable1[i].second) << kitchens[i].name;
    hashes.insert(kitchens[i].hash);
  }
  EXPECT_EQ(hashes.size(), kitchens.size());
}

TEST(BuiltinKitchens, ParseBack) {
  for (const Kitchen& kitchen : builtin_kitchens()) {
    const Kitchen again = parse_kitchen(kitchen.name, kitchen.text, kitchen.name);
    EXPECT_EQ(again.hash, kitchen.hash);
    EXPECT_EQ(again.text, kitchen.text);
    EXPECT_EQ(again.floor, kitchen.floor);
  }
}

// Made anew they must be those that older files name.
TEST(BuiltinKitchens, StayWhatTheyAre) {
  Hash hash;
  for (const Kitchen& kitchen : builtin_kitchens()) hash.add(kitchen.text);
  EXPECT_EQ(hex(hash.value()), "4c1493329de188d5");
}

TEST(BuiltinKitchens, HaveRoomForTheObjects) {
  for (int env = 0; env < all_kitchens().envs(); ++env) {
    EXPECT_GE(all_kitchens().tables(env).slots.size(), 10u);
    EXPECT_LE(all_kitchens().tables(env).slots.size(), size_t(kMaxKitchenSlots));
  }
}

}  // namespace
}  // namespace synpo
