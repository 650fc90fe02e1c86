#include "world/kitchen_set.h"

#include <algorithm>
#include <cstring>
#include <set>

#include "base/error.h"
#include "world/kitchen_plan.h"

namespace synpo {
namespace {

constexpr const char* kAgentField = "agent";
constexpr const char* kViewField = "view";

std::pair<int, int> field(const StartPlaces& places, const std::string& name) {
  const auto found = places.find(name);
  if (found == places.end()) fail(Exit::kData, quoted(name), ": found none, expected two numbers");
  return found->second;
}

}  // namespace

KitchenSet::KitchenSet(const std::vector<Kitchen>& kitchens) {
  std::set<std::string> names;
  for (const Kitchen& kitchen : kitchens) {
    if (!names.insert(kitchen.name).second) fail(Exit::kData, "two environments are named ", quoted(kitchen.name));
    environments_.push_back({kitchen.name, kitchen.hash, kitchen.text});
    rooms_.push_back(std::make_unique<const Room>(kitchen));
  }
}

KitchenSet::KitchenSet() : KitchenSet(builtin_kitchens()) {}

const std::string& KitchenSet::name() const {
  static const std::string name = "kitchen";
  return name;
}

const std::vector<std::string>& KitchenSet::task_names() const {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int task = 0; task < kKitchenTasks; ++task) all.push_back(kitchen_task(task).name());
    return all;
  }();
  return names;
}

const std::vector<std::string>& KitchenSet::action_names() const {
  static const std::vector<std::string> names(kKitchenActionNames, kKitchenActionNames + kKitchenActions);
  return names;
}

WorldState KitchenSet::reset(int env, Random& random) const { return pack(kitchen_reset(tables(env), random)); }

WorldStep KitchenSet::step(EnvTask pair, WorldState& state, int action) const {
  KitchenState at = unpack(state);
  const WorldStep step = kitchen_step(tables(pair.env), kitchen_task(pair.task), at, action);
  state = pack(at);
  return step;
}

int KitchenSet::expert(EnvTask pair, const WorldState& state) const { return planner(pair.env).action(kitchen_task(pair.task), unpack(state)); }

void KitchenSet::action_values(EnvTask pair, const WorldState& state, int* cents) const {
  const auto values = planner(pair.env).q_cents(kitchen_task(pair.task), unpack(state));
  std::copy(values.begin(), values.end(), cents);
}

bool KitchenSet::at_choice(EnvTask pair, const WorldState& state) const {
  const KitchenState at = unpack(state);
  if (at.hand == kEmptyHand) return object_in_reach(tables(pair.env), at.pose, at.doors, at.slots) >= 0;
  return receptacle_in_reach(tables(pair.env), at.pose, at.doors) >= 0;
}

KitchenFrame KitchenSet::frame(int env, const WorldState& state) const {
  const KitchenState at = unpack(state);
  const KitchenTables& all = tables(env);
  KitchenFrame frame;
  frame.eye = all.poses[at.pose];
  frame.doors = at.doors;
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    if (at.slots[i] == kNoSlot) continue;
    const KitchenCell& slot = all.slots[at.slots[i]];
    frame.objects[i] = int16_t(scene_cell(slot.row, slot.column));
  }
  return frame;
}

void KitchenSet::observe(int env, const StateHistory& history, int, uint8_t* observation) const {
  constexpr size_t kView = kViewFeatures * sizeof(float);
  const int missing = kHistory - history.count;
  std::memset(observation, 0, size_t(missing) * kView);
  for (int i = missing; i < kHistory; ++i)
    std::memcpy(observation + size_t(i) * kView, view_features(scene(env), frame(env, history.states[size_t(i)])), kView);
  float hand[kHandFloats] = {float(unpack(history.now()).hand)};
  std::memcpy(observation + kHistory * kView, hand, sizeof hand);
}

StartPlaces KitchenSet::start_places(int env, const WorldState& start) const {
  const KitchenState at = unpack(start);
  const KitchenPose& pose = tables(env).poses[at.pose];
  StartPlaces places = {{kAgentField, {pose.row, pose.column}}, {kViewField, {pose.heading, pose.horizon}}};
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const KitchenCell& slot = tables(env).slots[at.slots[i]];
    places[kKitchenObjectNames[i]] = {slot.row, slot.column};
  }
  return places;
}

WorldState KitchenSet::start_state(int env, const StartPlaces& places) const {
  const KitchenTables& all = tables(env);
  const auto [row, column] = field(places, kAgentField);
  const auto [heading, horizon] = field(places, kViewField);
  KitchenState state;
  bool stands = false, found = false;
  for (const uint16_t i : all.start_poses) {
    const KitchenPose& pose = all.poses[i];
    if (pose.row != row || pose.column != column) continue;
    stands = true;
    if (pose.heading != heading || pose.horizon != horizon) continue;
    state.pose = i;
    found = true;
  }
  if (!stands) fail(Exit::kData, "'", kAgentField, "': found row ", row, ", column ", column, ", which is not a free cell");
  if (!found) fail(Exit::kData, "'", kViewField, "': found heading ", heading, ", horizon ", horizon, ", with which no episode starts");
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const auto [slot_row, slot_column] = field(places, kKitchenObjectNames[i]);
    const std::string where = concat("'", kKitchenObjectNames[i], "': found row ", slot_row, ", column ", slot_column, ", ");
    const auto slot = std::find_if(all.slots.begin(), all.slots.end(),
                                   [&, r = slot_row, c = slot_column](const KitchenCell& cell) { return cell.row == r && cell.column == c; });
    if (slot == all.slots.end()) fail(Exit::kData, where, "where no object can lie");
    state.slots[i] = uint8_t(slot - all.slots.begin());
    if (std::find(state.slots.begin(), state.slots.begin() + int(i), state.slots[i]) != state.slots.begin() + int(i))
      fail(Exit::kData, where, "where another object lies");
  }
  for (const auto& [name, place] : places)
    if (name != kAgentField && name != kViewField && std::count(kKitchenObjectNames, kKitchenObjectNames + kKitchenObjects, name) == 0)
      fail(Exit::kData, "found ", quoted(name), ", expected agent, view and the seven objects");
  return pack(state);
}

bool KitchenSet::valid(EnvTask pair, const WorldState& state) const { return kitchen_valid(tables(pair.env), kitchen_task(pair.task), state); }

}  // namespace synpo
