#include "world/kitchen/rules.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "helpers/kitchens.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

constexpr KitchenTask kMugToFridge = {2, kFridge}, kMugToSink = {2, kSink};

// Objects 0 to 6 on slots 4 to 9 and 3, but the Mug on `mug` and the Tomato on `tomato`.
KitchenState ring_state(int pose, int mug, int tomato) {
  KitchenState state;
  state.pose = uint16_t(pose);
  state.slots = {4, 5, uint8_t(mug), uint8_t(tomato), 6, 7, 8};
  return state;
}

KitchenState with_mug(int pose, int doors) {
  KitchenState state = ring_state(pose, kNoSlot, 9);
  state.hand = 2;
  state.doors = uint8_t(doors);
  return state;
}

void expect_step(KitchenTask task, KitchenState state, int action, int cents, const KitchenState& after) {
  const WorldStep step = kitchen_step(ring_tables(), task, state, action);
  EXPECT_EQ(step.reward_cents, cents) << kKitchenActionNames[action];
  EXPECT_FALSE(step.ended() || step.success || step.wrong) << kKitchenActionNames[action];
  KitchenState expected = after;
  expected.steps = 1;
  EXPECT_EQ(state, expected) << kKitchenActionNames[action];
}

void expect_end(KitchenTask task, KitchenState state, int cents, bool success) {
  const WorldStep step = kitchen_step(ring_tables(), task, state, kPickupPut);
  EXPECT_EQ(step.reward_cents, cents);
  EXPECT_TRUE(step.terminated);
  EXPECT_FALSE(step.truncated);
  EXPECT_EQ(step.success, success);
  EXPECT_EQ(step.wrong, !success);
}

TEST(KitchenRules, MovesCostOneCentAndFailedOnesTwo) {
  const KitchenState at = ring_state(1, 0, 9);
  expect_step(kMugToFridge, at, kRotateRight, -1, ring_state(2, 0, 9));
  expect_step(kMugToFridge, at, kRotateLeft, -1, ring_state(0, 0, 9));
  for (const int action : {kMoveAhead, kLookUp, kLookDown}) expect_step(kMugToFridge, at, action, -2, at);
}

TEST(KitchenRules, DoorsOpenAndCloseTheNearest) {
  for (const int pose : {0, 1})
    expect_step(kMugToFridge, ring_state(pose, 0, 9), kOpenClose, -2, ring_state(pose, 0, 9));
  for (const int pose :
       {2,
        3}) {  // the Sink, which has no door, stands before the Fridge in the one, the Microwave behind it in the other
    KitchenState open = ring_state(pose, 0, 9);
    open.doors = 1;
    expect_step(kMugToFridge, ring_state(pose, 0, 9), kOpenClose, -1, open);
    expect_step(kMugToFridge, open, kOpenClose, -1, ring_state(pose, 0, 9));
  }
}

TEST(KitchenRules, PickupTakesTheNearest) {
  expect_step(kMugToFridge, ring_state(0, 0, 9), kPickupPut, -2, ring_state(0, 0, 9));
  expect_step(kMugToFridge, ring_state(1, 9, 3), kPickupPut, -2, ring_state(1, 9, 3));
  for (const auto& [mug, tomato] :
       {std::pair{0, 9}, {1, 0}, {2, 0}, {1, 2}, {2, 1}}) {  // of equally near ones the Mug comes first
    KitchenState after = ring_state(1, kNoSlot, tomato);
    after.hand = 2;
    expect_step(kMugToFridge, ring_state(1, mug, tomato), kPickupPut, 99, after);
  }
  for (const int tomato : {1, 2}) expect_end(kMugToFridge, ring_state(1, 0, tomato), -1001, false);
  expect_end({3, kFridge}, ring_state(1, 1, 2), -1001, false);
  expect_end({3, kFridge}, ring_state(1, 2, 1), -1001, false);
}

TEST(KitchenRules, PutFillsTheNearestThatIsOpen) {
  for (const int doors : {0, 1, 2, 3})
    for (const int pose : {0, 1})
      expect_step(kMugToFridge, with_mug(pose, doors), kPickupPut, -2, with_mug(pose, doors));
  expect_step(kMugToFridge, with_mug(3, 0), kPickupPut, -2, with_mug(3, 0));
  expect_end(kMugToFridge, with_mug(3, 1), 999, true);
  expect_end(kMugToFridge, with_mug(3, 3), 999, true);
  expect_end(kMugToFridge, with_mug(3, 2), -1001, false);
  expect_end({2, kMicrowave}, with_mug(3, 2), 999, true);
  expect_end({2, kMicrowave}, with_mug(3, 3), -1001, false);
  expect_end(kMugToFridge, with_mug(2, 1), -1001, false);
  expect_end(kMugToSink, with_mug(2, 1), 999, true);
}

TEST(KitchenRules, EpisodesAreCutAt300Steps) {
  KitchenState state = ring_state(0, 0, 9);
  for (int i = 1; i <= 300; ++i) {
    const WorldStep step = kitchen_step(ring_tables(), kMugToFridge, state, kPickupPut);
    ASSERT_EQ(step.truncated, i == 300);
    ASSERT_FALSE(step.terminated || step.success || step.wrong);
  }
  KitchenState last = with_mug(3, 1);
  last.steps = 299;
  const WorldStep step = kitchen_step(ring_tables(), kMugToFridge, last, kPickupPut);
  EXPECT_TRUE(step.terminated && step.success);
  EXPECT_FALSE(step.truncated);
}

TEST(KitchenRules, OnlyStatesOfRunningEpisodesAreValid) {
  const KitchenTables tables = ring_tables();
  const auto valid = [&](const KitchenState& state) { return kitchen_valid(tables, kMugToFridge, pack(state)); };
  EXPECT_TRUE(valid(ring_state(3, 0, 9)));
  EXPECT_TRUE(valid(with_mug(3, 3)));
  EXPECT_FALSE(valid(ring_state(5, 0, 9)));
  EXPECT_FALSE(valid(ring_state(3, 9, 9)));
  EXPECT_FALSE(valid(ring_state(3, 10, 9)));
  EXPECT_FALSE(valid(ring_state(3, kNoSlot, 9)));
  EXPECT_FALSE(valid(with_mug(3, 4)));
  KitchenState state = with_mug(0, 0);
  state.slots[2] = 0;
  EXPECT_FALSE(valid(state));
  state = ring_state(0, 0, kNoSlot);
  state.hand = 3;
  EXPECT_FALSE(valid(state));
  state.hand = 8;
  EXPECT_FALSE(valid(state));
  state = ring_state(0, 0, 9);
  state.steps = 300;
  EXPECT_FALSE(valid(state));
  WorldState world = pack(ring_state(0, 0, 9));
  EXPECT_EQ(unpack(world), ring_state(0, 0, 9));
  world.bytes[13] = 1;
  EXPECT_FALSE(kitchen_valid(tables, kMugToFridge, world));
}

}  // namespace
}  // namespace synpo
