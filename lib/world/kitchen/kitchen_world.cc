#include "world/kitchen/kitchen_world.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "base/error.h"
#include "world/kitchen/view/features.h"
#include "world/observation.h"

namespace synpo {
namespace {

constexpr const char* kAgentField = "agent";
constexpr const char* kViewField = "view";

std::pair<int, int> field(const StartPlaces& places, const std::string& name) {
  const auto found = places.find(name);
  if (found == places.end()) fail(Exit::kData, quoted(name), ": found none, expected two numbers");
  return found->second;
}

bool is_field(const std::string& name) {
  const auto* const end = kKitchenObjectNames + kKitchenObjects;
  return name == kAgentField || name == kViewField || std::find(kKitchenObjectNames, end, name) != end;
}

// The pose of a start.
uint16_t start_pose(const KitchenTables& tables, const StartPlaces& places) {
  const auto [row, column] = field(places, kAgentField);
  const auto [heading, horizon] = field(places, kViewField);
  bool stands = false;
  for (const uint16_t i : tables.start_poses) {
    const KitchenPose& pose = tables.poses[i];
    if (pose.row != row || pose.column != column) continue;
    stands = true;
    if (pose.heading == heading && pose.horizon == horizon) return i;
  }
  if (!stands)
    fail(Exit::kData, "'", kAgentField, "': found row ", row, ", column ", column, ", which is not a free cell");
  fail(Exit::kData, "'", kViewField, "': found heading ", heading, ", horizon ", horizon,
       ", with which no episode starts");
}

WorldFacts kitchen_facts(const std::string& extractor) {
  WorldFacts facts = {.name = "kitchen",
                      .rules = kKitchenRules,
                      .actions = {kKitchenActionNames, kKitchenActionNames + kKitchenActions},
                      .moves = kKitchenMoves,
                      .state_bytes = kKitchenStateBytes,
                      .observation = {.sight = Sight::kFeatures, .view = kViewFeatures, .objects = kKitchenObjects + 1},
                      .extractor = extractor};
  for (int task = 0; task < kKitchenTasks; ++task) facts.tasks.push_back(kitchen_task(task).name());
  return facts;
}

}  // namespace

KitchenWorld::KitchenWorld(const std::string& extractor) : World(kitchen_facts(extractor)) {}

WorldStep KitchenWorld::step(EnvTask pair, WorldState& state, int action) const {
  KitchenState at = unpack(state);
  const WorldStep step = kitchen_step(planned_for(pair.env, at).tables, kitchen_task(pair.task), at, action);
  state = pack(at);
  return step;
}

int KitchenWorld::expert(EnvTask pair, const WorldState& state) const {
  const KitchenState at = unpack(state);
  return planned_for(pair.env, at).planner.action(kitchen_task(pair.task), at);
}

void KitchenWorld::action_values(EnvTask pair, const WorldState& state, int* cents) const {
  const KitchenState at = unpack(state);
  const auto values = planned_for(pair.env, at).planner.q_cents(kitchen_task(pair.task), at);
  std::copy(values.begin(), values.end(), cents);
}

bool KitchenWorld::at_choice(EnvTask pair, const WorldState& state) const {
  const KitchenState at = unpack(state);
  const KitchenTables& tables = planned_for(pair.env, at).tables;
  if (at.hand == kEmptyHand) return object_in_reach(tables, at.pose, at.doors, at.slots) >= 0;
  return receptacle_in_reach(tables, at.pose, at.doors) >= 0;
}

void KitchenWorld::observe(int env, const StateHistory& history, int, uint8_t* observation) const {
  constexpr size_t kViewBytes = kViewFeatures * sizeof(float);
  const int missing = kHistory - history.count;
  std::memset(observation, 0, size_t(missing) * kViewBytes);
  for (int i = missing; i < kHistory; ++i)
    write_view(env, unpack(history.states[size_t(i)]), reinterpret_cast<float*>(observation + size_t(i) * kViewBytes));
  const float hand[ObservationSpec::kObjectFloats] = {float(unpack(history.now()).hand)};
  std::memcpy(observation + kHistory * kViewBytes, hand, sizeof hand);
}

StartPlaces KitchenWorld::start_places(int env, const WorldState& start) const {
  const KitchenState at = unpack(start);
  const KitchenTables& tables = planned_for(env, at).tables;
  const KitchenPose& pose = tables.poses[at.pose];
  StartPlaces places = {{kAgentField, {pose.row, pose.column}}, {kViewField, {pose.heading, pose.horizon}}};
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const KitchenCell& slot = tables.slots[at.slots[i]];
    places[kKitchenObjectNames[i]] = {slot.row, slot.column};
  }
  return places;
}

WorldState KitchenWorld::start_state(int env, const StartPlaces& places) const {
  KitchenState state;
  state.pose = start_pose(planned(env, 0).tables, places);
  Places objects;
  for (size_t i = 0; i < kKitchenObjects; ++i) objects[i] = field(places, kKitchenObjectNames[i]);
  place_objects(env, objects, state);
  for (const auto& [name, place] : places)
    if (!is_field(name)) fail(Exit::kData, "found ", quoted(name), ", expected agent, view and the seven objects");
  return pack(state);
}

bool KitchenWorld::valid(EnvTask pair, const WorldState& state) const {
  const KitchenState at = unpack(state);
  return at.layout < layouts(pair.env) &&
         kitchen_valid(planned_for(pair.env, at).tables, kitchen_task(pair.task), state);
}

}  // namespace synpo
