// The kitchens' rules.
//
// Seven objects lie on distinct slots. A task is to put one of them into a receptacle. Actions MoveAhead RotateLeft
// RotateRight LookUp LookDown OpenClose PickupPut cost 0.01 each; an invalid one costs another 0.01 and changes
// nothing: to move into something, to look past the last horizon, to open or close where no door is visible, to pick up
// where no object is visible, to put where no receptacle is visible that is open or needs no opening. OpenClose turns
// the door of the nearest visible receptacle that has one. PickupPut with an empty hand takes the nearest visible
// object (of equally near ones the first): the right one gives +1, any other -10 and ends the episode. With an object
// in the hand it puts that into the nearest visible receptacle that is open or needs no opening: the right one gives
// +10 and ends the episode in success, any other -10 and ends it. After 300 steps an episode that has not ended is cut:
// truncated, not terminated.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/tables.h"
#include "world/world.h"

namespace synpo {

constexpr int kKitchenRules = 1;  // version of the rules above; trajectories and checkpoints carry it
constexpr int kKitchenActions = 7;
extern const char* const kKitchenActionNames[kKitchenActions];
enum KitchenAction : uint8_t { kMoveAhead, kRotateLeft, kRotateRight, kLookUp, kLookDown, kOpenClose, kPickupPut };

constexpr int kInvalidCents = -1;  // in hundredths: on top of a step's, as are the others
constexpr int kStepCents = -1, kPickedCents = 100, kFilledCents = 1000, kWrongCents = -1000;

constexpr uint8_t kEmptyHand = kKitchenObjects;
constexpr uint8_t kNoSlot = 255;  // of an object in the hand or in a receptacle

struct KitchenState {
  uint16_t pose = 0;
  uint8_t doors = 0;  // bit 0: the Fridge is open, bit 1: the Microwave
  uint8_t hand = kEmptyHand;
  std::array<uint8_t, kKitchenObjects> slots = {};  // of the objects
  uint16_t steps = 0;
  uint16_t layout =
      0;  // of those that a kitchen from a file has (recorded_kitchens.h); tables and slots are that layout's
  bool operator==(const KitchenState&) const = default;
};

// The pose in two bytes, low one first, then doors, hand, slots, the layout in two, and a zero.
constexpr size_t kKitchenStateBytes = 14;
WorldState pack(const KitchenState& state);
KitchenState unpack(const WorldState& state);

// Start pose and distinct slots, all alike likely; doors closed, hand empty.
KitchenState kitchen_reset(const KitchenTables& tables, Random& random);
WorldStep kitchen_step(const KitchenTables& tables, KitchenTask task, KitchenState& state, int action);

// The object that PickupPut would take with an empty hand, or -1.
int object_in_reach(const KitchenTables& tables, int pose, int doors,
                    const std::array<uint8_t, kKitchenObjects>& slots);
// The receptacle that OpenClose would turn, or -1.
int door_in_reach(const KitchenTables& tables, int pose, int doors);
// The receptacle that PickupPut would fill with an object in the hand, or -1.
int receptacle_in_reach(const KitchenTables& tables, int pose, int doors);
// Through what a running episode can come that begins with the objects on these slots, [doors, poses, kKitchenObjects +
// 1]: where the agent is, and what it has in its hand, kEmptyHand for nothing.
std::vector<bool> kitchen_reachable(const KitchenTables& tables, const std::array<uint8_t, kKitchenObjects>& slots);
// Whether this can be a state of a running episode of a task; the layout is not looked at.
bool kitchen_valid(const KitchenTables& tables, KitchenTask task, const WorldState& state);

}  // namespace synpo
