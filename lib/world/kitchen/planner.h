// The expert of a kitchen: exact shortest plans over pose, doors and hand.
//
// With the object in the hand the way to a receptacle depends on nothing else, and is found once. The way to the object
// depends on where all objects lie; such tables are made when they are asked for, and the latest are kept. What comes
// out does not depend on what was kept.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/rules.h"

namespace synpo {

class KitchenPlanner {
 public:
  // `tables` must outlive it. Throws kData, naming the kitchen, where a receptacle cannot be used from some pose.
  KitchenPlanner(const std::string& name, const KitchenTables& tables);

  // Whether there is a way to success from here.
  bool has_plan(KitchenTask task, const KitchenState& state) const;
  // Steps of the expert's episode from here to success. This and the next throw kInternal where objects lie so that
  // there is none, which kitchen_tables() and RecordedKitchens exclude.
  int steps_to_success(KitchenTask task, const KitchenState& state) const;
  // The best action; ties go to the first in the order of the actions.
  int action(KitchenTask task, const KitchenState& state) const;
  // Undiscounted return in hundredths of taking each action now and acting optimally after, without the step limit.
  std::array<int, kKitchenActions> q_cents(KitchenTask task, const KitchenState& state) const;

 private:
  using Steps = std::vector<uint16_t>;  // [doors, poses] to success
  struct Kept {
    int task = -1;
    std::array<uint8_t, kKitchenObjects> slots;
    std::shared_ptr<const Steps> steps;
  };

  size_t index(int pose, int doors) const { return size_t(doors) * tables_->poses.size() + size_t(pose); }
  void relax(Steps& steps) const;
  Steps steps_with_empty_hand(KitchenTask task, const std::array<uint8_t, kKitchenObjects>& slots) const;
  std::shared_ptr<const Steps> find(KitchenTask task, const KitchenState& state) const;

  const KitchenTables* tables_;
  std::vector<uint32_t> before_begin_;  // [poses + 1]
  std::vector<uint16_t> before_;        // the poses from which a move leads to each
  std::vector<int8_t> door_;            // [doors, poses], door_in_reach()
  std::array<std::shared_ptr<const Steps>, kKitchenReceptacles> to_receptacle_;
  mutable std::mutex mutex_;
  mutable std::vector<Kept> kept_;  // a ring
  mutable size_t oldest_ = 0;
};

}  // namespace synpo
