#include "world/kitchen/rules.h"

#include <algorithm>

namespace synpo {

const char* const kKitchenActionNames[kKitchenActions] = {"MoveAhead", "RotateLeft", "RotateRight", "LookUp",
                                                          "LookDown",  "OpenClose",  "PickupPut"};

namespace {
constexpr size_t kDoorsByte = 2, kHandByte = 3, kSlotBytes = 4, kLayoutBytes = kSlotBytes + kKitchenObjects;
}

WorldState pack(const KitchenState& state) {
  WorldState world;
  world.bytes[0] = uint8_t(state.pose);
  world.bytes[1] = uint8_t(state.pose >> 8);
  world.bytes[kDoorsByte] = state.doors;
  world.bytes[kHandByte] = state.hand;
  std::copy(state.slots.begin(), state.slots.end(), world.bytes.begin() + kSlotBytes);
  world.bytes[kLayoutBytes] = uint8_t(state.layout);
  world.bytes[kLayoutBytes + 1] = uint8_t(state.layout >> 8);
  world.steps = state.steps;
  return world;
}

KitchenState unpack(const WorldState& world) {
  KitchenState state;
  state.pose = uint16_t(world.bytes[0] | world.bytes[1] << 8);
  state.doors = world.bytes[kDoorsByte];
  state.hand = world.bytes[kHandByte];
  std::copy_n(world.bytes.begin() + kSlotBytes, kKitchenObjects, state.slots.begin());
  state.layout = uint16_t(world.bytes[kLayoutBytes] | world.bytes[kLayoutBytes + 1] << 8);
  state.steps = world.steps;
  return state;
}

KitchenState kitchen_reset(const KitchenTables& tables, Random& random) {
  KitchenState state;
  state.pose = tables.start_poses[random.below(uint32_t(tables.start_poses.size()))];
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const auto placed = state.slots.begin() + int(i);
    do state.slots[i] = uint8_t(random.below(uint32_t(tables.slots.size())));
    while (std::find(state.slots.begin(), placed, state.slots[i]) != placed);
  }
  return state;
}

int object_in_reach(const KitchenTables& tables, int pose, int doors,
                    const std::array<uint8_t, kKitchenObjects>& slots) {
  int nearest = -1;
  uint16_t distance = 0;
  for (const KitchenSeen& seen : tables.sight[size_t(doors)]->slots.at(pose)) {
    if (nearest >= 0 && seen.distance > distance) break;
    const auto found = std::find(slots.begin(), slots.end(), seen.index);
    if (found == slots.end()) continue;
    const int object = int(found - slots.begin());
    nearest = nearest < 0 ? object : std::min(nearest, object);
    distance = seen.distance;
  }
  return nearest;
}

int door_in_reach(const KitchenTables& tables, int pose, int doors) {
  for (const KitchenSeen& seen : tables.sight[size_t(doors)]->receptacles.at(pose))
    if (seen.index < kKitchenDoors) return seen.index;
  return -1;
}

int receptacle_in_reach(const KitchenTables& tables, int pose, int doors) {
  for (const KitchenSeen& seen : tables.sight[size_t(doors)]->receptacles.at(pose))
    if (seen.index >= kKitchenDoors || (doors >> seen.index & 1)) return seen.index;
  return -1;
}

WorldStep kitchen_step(const KitchenTables& tables, KitchenTask task, KitchenState& state, int action) {
  WorldStep step = {kStepCents, false, false, false, false};
  ++state.steps;
  const auto wrong = [&] {
    step.reward_cents += kWrongCents;
    step.terminated = step.wrong = true;
  };
  if (action < kKitchenMoves) {
    const int to = tables.next_pose(state.pose, action);
    if (to == state.pose) step.reward_cents += kInvalidCents;
    state.pose = uint16_t(to);
  } else if (action == kOpenClose) {
    const int door = door_in_reach(tables, state.pose, state.doors);
    if (door < 0)
      step.reward_cents += kInvalidCents;
    else
      state.doors = uint8_t(state.doors ^ 1 << door);
  } else if (state.hand == kEmptyHand) {
    const int object = object_in_reach(tables, state.pose, state.doors, state.slots);
    if (object < 0) {
      step.reward_cents += kInvalidCents;
    } else {
      state.hand = uint8_t(object);
      state.slots[size_t(object)] = kNoSlot;
      if (object == task.object)
        step.reward_cents += kPickedCents;
      else
        wrong();
    }
  } else {
    const int receptacle = receptacle_in_reach(tables, state.pose, state.doors);
    if (receptacle < 0) {
      step.reward_cents += kInvalidCents;
    } else {
      const bool right = state.hand == task.object && receptacle == task.receptacle;
      state.hand = kEmptyHand;
      if (right) {
        step.reward_cents += kFilledCents;
        step.terminated = step.success = true;
      } else {
        wrong();
      }
    }
  }
  step.truncated = !step.terminated && state.steps >= kStepLimit;
  return step;
}

std::vector<bool> kitchen_reachable(const KitchenTables& tables, const std::array<uint8_t, kKitchenObjects>& slots) {
  constexpr size_t kHands = kKitchenObjects + 1;
  const size_t poses = tables.poses.size();
  std::vector<bool> reached(kDoorStates * poses * kHands, false);
  std::vector<size_t> open;
  const auto reach = [&](int doors, int pose, int hand) {
    const size_t at = (size_t(doors) * poses + size_t(pose)) * kHands + size_t(hand);
    if (reached[at]) return;
    reached[at] = true;
    open.push_back(at);
  };
  for (const uint16_t pose : tables.start_poses) reach(0, pose, kEmptyHand);
  while (!open.empty()) {
    const size_t at = open.back();
    open.pop_back();
    const int hand = int(at % kHands), pose = int(at / kHands % poses), doors = int(at / kHands / poses);
    for (int move = 0; move < kKitchenMoves; ++move) reach(doors, tables.next_pose(pose, move), hand);
    if (const int door = door_in_reach(tables, pose, doors); door >= 0) reach(doors ^ 1 << door, pose, hand);
    if (hand != kEmptyHand) continue;
    if (const int object = object_in_reach(tables, pose, doors, slots); object >= 0) reach(doors, pose, object);
  }
  return reached;
}

bool kitchen_valid(const KitchenTables& tables, KitchenTask task, const WorldState& world) {
  const KitchenState state = unpack(world);
  if (pack(state) != world || state.pose >= tables.poses.size() || state.doors >= kDoorStates ||
      state.steps >= kStepLimit)
    return false;
  if (state.hand != kEmptyHand && state.hand != task.object) return false;
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const uint8_t slot = state.slots[i];
    if (state.hand == i ? slot != kNoSlot : slot >= tables.slots.size()) return false;
    if (std::count(state.slots.begin(), state.slots.end(), slot) > 1) return false;
  }
  return true;
}

}  // namespace synpo
