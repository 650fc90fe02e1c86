// The tables that the rules of the kitchens run on, over the poses of the agent, made once per kitchen. They know no
// geometry, so that they can be filled from a plan (make_tables.h) or from a file.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "world/kitchen/geometry/kitchen.h"

namespace synpo {

constexpr int kKitchenMoves = 5;      // MoveAhead RotateLeft RotateRight LookUp LookDown
constexpr int kDoorStates = 4;        // bit 0: the Fridge is open, bit 1: the Microwave
constexpr int kMaxKitchenSlots = 64;  // places on which an object may lie
constexpr int kMaxKitchenPoses = 65535;

// Where the agent stands and looks, in degrees: heading clockwise from north, horizon below the level.
struct KitchenPose {
  int16_t row, column, heading, horizon;
  bool operator==(const KitchenPose&) const = default;
};

// A slot or receptacle in sight. Equal distances are ties.
struct KitchenSeen {
  uint16_t distance;  // horizontal, millimetres
  uint8_t index;
  bool operator==(const KitchenSeen&) const = default;
};

// For every pose a list, nearest first and then by index.
struct KitchenSeenLists {
  std::vector<uint32_t> begin = {0};  // [poses + 1]
  std::vector<KitchenSeen> items;
  std::span<const KitchenSeen> at(int pose) const {
    return {items.data() + begin[size_t(pose)], items.data() + begin[size_t(pose) + 1]};
  }
};

// The things in sight from every pose while the doors stand in one way.
struct KitchenSight {
  KitchenSeenLists slots, receptacles;
};

struct KitchenTables {
  std::vector<KitchenPose> poses;     // no two alike
  std::vector<KitchenCell> slots;     // where an object may lie; no two alike in a plan
  std::vector<uint16_t> start_poses;  // where an episode may start, all alike likely; ascending
  std::vector<uint16_t> next;  // [poses, kKitchenMoves]: the pose after a move; the same pose where the move fails
  std::array<std::shared_ptr<const KitchenSight>, kDoorStates> sight;  // by doors; may be one and the same

  int pose_count() const { return int(poses.size()); }
  int next_pose(int pose, int move) const { return next[size_t(pose) * kKitchenMoves + size_t(move)]; }
};

}  // namespace synpo
