#include "world/kitchen/planner.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "world/world.h"

namespace synpo {
namespace {
constexpr uint16_t kFar = 65535;
constexpr size_t kKeptTables = 64;

int checked(KitchenTask task, uint16_t steps) {
  if (steps == kFar) fail(Exit::kInternal, "no plan for ", task.name(), " where the objects lie");
  return steps;
}

}  // namespace

KitchenPlanner::KitchenPlanner(const std::string& name, const KitchenTables& tables)
    : tables_(&tables), before_begin_(tables.poses.size() + 1, 0), door_(tables.poses.size() * kDoorStates),
      kept_(kKeptTables) {
  const int poses = tables.pose_count();
  std::vector<std::vector<uint16_t>> before(tables.poses.size());
  for (int pose = 0; pose < poses; ++pose)
    for (int move = 0; move < kKitchenMoves; ++move)
      if (const int to = tables.next_pose(pose, move); to != pose) before[size_t(to)].push_back(uint16_t(pose));
  for (size_t pose = 0; pose < before.size(); ++pose) {
    before_.insert(before_.end(), before[pose].begin(), before[pose].end());
    before_begin_[pose + 1] = uint32_t(before_.size());
  }
  for (int doors = 0; doors < kDoorStates; ++doors)
    for (int pose = 0; pose < poses; ++pose) door_[index(pose, doors)] = int8_t(door_in_reach(tables, pose, doors));
  for (int receptacle = 0; receptacle < kKitchenReceptacles; ++receptacle) {
    Steps steps(door_.size(), kFar);
    for (int doors = 0; doors < kDoorStates; ++doors)
      for (int pose = 0; pose < poses; ++pose)
        if (receptacle_in_reach(tables, pose, doors) == receptacle) steps[index(pose, doors)] = 1;
    relax(steps);
    if (const auto far = std::find(steps.begin(), steps.end(), kFar); far != steps.end()) {
      const KitchenPose& pose = tables.poses[size_t(far - steps.begin()) % tables.poses.size()];
      fail(Exit::kData, name, ": the ", kKitchenReceptacleNames[receptacle], " cannot be used from row ", pose.row,
           ", column ", pose.column, ", heading ", pose.heading, ", horizon ", pose.horizon);
    }
    to_receptacle_[size_t(receptacle)] = std::make_shared<const Steps>(std::move(steps));
  }
}

// Lowers every state's steps to one more than those of a state that a move or a door leads to. States are taken in the
// order of their steps: those given at first from buckets, those lowered on the way from the level before.
void KitchenPlanner::relax(Steps& steps) const {
  const size_t poses = tables_->poses.size();
  std::vector<std::vector<uint32_t>> given;
  for (size_t state = 0; state < steps.size(); ++state) {
    if (steps[state] == kFar) continue;
    if (given.size() <= steps[state]) given.resize(steps[state] + 1u);
    given[steps[state]].push_back(uint32_t(state));
  }
  std::vector<uint32_t> level, next;
  for (uint32_t now = 0; now < given.size() || !level.empty(); ++now) {
    if (now < given.size()) level.insert(level.end(), given[now].begin(), given[now].end());
    next.clear();
    for (const uint32_t state : level) {
      if (steps[state] != now) continue;  // given, and lowered since
      const auto lower = [&](size_t from) {
        if (steps[from] <= now + 1) return;
        steps[from] = uint16_t(now + 1);
        next.push_back(uint32_t(from));
      };
      const size_t doors = state / poses, pose = state % poses;
      for (uint32_t i = before_begin_[pose]; i < before_begin_[pose + 1]; ++i) lower(doors * poses + before_[i]);
      for (int door = 0; door < kKitchenDoors; ++door) {
        const size_t from = (doors ^ size_t(1) << door) * poses + pose;
        if (door_[from] == door) lower(from);
      }
    }
    level.swap(next);
  }
}

KitchenPlanner::Steps KitchenPlanner::steps_with_empty_hand(KitchenTask task,
                                                            const std::array<uint8_t, kKitchenObjects>& slots) const {
  const Steps& after = *to_receptacle_[size_t(task.receptacle)];
  Steps steps(after.size(), kFar);
  const int poses = tables_->pose_count();
  for (int doors = 0; doors < kDoorStates; ++doors) {
    const bool as_closed = doors > 0 && tables_->sight[size_t(doors)] == tables_->sight[0];
    for (int pose = 0; pose < poses; ++pose) {
      const bool reached =
          as_closed ? steps[index(pose, 0)] != kFar : object_in_reach(*tables_, pose, doors, slots) == task.object;
      if (reached) steps[index(pose, doors)] = uint16_t(after[index(pose, doors)] + 1);
    }
  }
  relax(steps);
  return steps;
}

std::shared_ptr<const KitchenPlanner::Steps> KitchenPlanner::find(KitchenTask task, const KitchenState& state) const {
  if (state.hand != kEmptyHand) return to_receptacle_[size_t(task.receptacle)];
  const int number = task.object * kKitchenReceptacles + task.receptacle;
  const auto same = [&](const Kept& kept) { return kept.task == number && kept.slots == state.slots; };
  {
    const std::lock_guard lock(mutex_);
    if (const auto kept = std::find_if(kept_.begin(), kept_.end(), same); kept != kept_.end()) return kept->steps;
  }
  auto steps = std::make_shared<const Steps>(steps_with_empty_hand(task, state.slots));
  const std::lock_guard lock(mutex_);
  if (std::none_of(kept_.begin(), kept_.end(), same)) {
    kept_[oldest_] = {number, state.slots, steps};
    oldest_ = (oldest_ + 1) % kept_.size();
  }
  return steps;
}

bool KitchenPlanner::has_plan(KitchenTask task, const KitchenState& state) const {
  return (*find(task, state))[index(state.pose, state.doors)] != kFar;
}

int KitchenPlanner::steps_to_success(KitchenTask task, const KitchenState& state) const {
  return checked(task, (*find(task, state))[index(state.pose, state.doors)]);
}

int KitchenPlanner::action(KitchenTask task, const KitchenState& state) const {
  const std::shared_ptr<const Steps> steps = find(task, state);
  const int left = checked(task, (*steps)[index(state.pose, state.doors)]) - 1;
  for (int move = 0; move < kKitchenMoves; ++move)
    if ((*steps)[index(tables_->next_pose(state.pose, move), state.doors)] == left) return move;
  const int door = door_[index(state.pose, state.doors)];
  if (door >= 0 && (*steps)[index(state.pose, state.doors ^ 1 << door)] == left) return kOpenClose;
  return kPickupPut;
}

std::array<int, kKitchenActions> KitchenPlanner::q_cents(KitchenTask task, const KitchenState& state) const {
  std::array<int, kKitchenActions> q;
  for (int action = 0; action < kKitchenActions; ++action) {
    KitchenState next = state;
    const WorldStep step = kitchen_step(*tables_, task, next, action);
    q[size_t(action)] = step.reward_cents;
    if (step.terminated) continue;
    q[size_t(action)] +=
        (next.hand == kEmptyHand ? kPickedCents : 0) + kFilledCents + kStepCents * steps_to_success(task, next);
  }
  return q;
}

}  // namespace synpo
