#include "world/kitchen/recorded_kitchens.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/half.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/view/features.h"

namespace synpo {
namespace {

constexpr int kHands = kKitchenObjects + 1;
constexpr std::array<uint8_t, kKitchenObjects> kOwnSlots = {0, 1, 2, 3, 4, 5, 6};

std::string text_of(const KitchenPose& pose) {
  return concat("row ", pose.row, ", column ", pose.column, ", heading ", pose.heading, ", horizon ", pose.horizon);
}

void check_poses(const std::string& name, const std::vector<KitchenPose>& poses) {
  std::set<std::array<int16_t, 4>> known;
  for (const KitchenPose& pose : poses)
    if (!known.insert({pose.row, pose.column, pose.heading, pose.horizon}).second)
      fail(Exit::kData, name, ": two poses are alike: ", text_of(pose));
}

// A start names its layout by where the objects lie.
void check_layouts(const std::string& name, const std::vector<KitchenTables>& layouts) {
  std::map<std::array<int16_t, 2 * kKitchenObjects>, size_t> known;
  for (size_t i = 0; i < layouts.size(); ++i) {
    std::array<int16_t, 2 * kKitchenObjects> cells;
    for (size_t object = 0; object < kKitchenObjects; ++object) {
      cells[2 * object] = layouts[i].slots[object].row;
      cells[2 * object + 1] = layouts[i].slots[object].column;
    }
    if (const auto [found, fresh] = known.emplace(cells, i); !fresh)
      fail(Exit::kData, name, ": in layouts ", found->second, " and ", i,
           " the objects lie in the same cells, expected no two layouts alike");
  }
}

}  // namespace

RecordedKitchens::Prepared::Prepared(RecordedKitchen from) : kitchen(std::move(from)) {
  std::vector<KitchenTables> tables = std::move(kitchen.layouts);
  kitchen.layouts.clear();
  check_poses(kitchen.name, tables.at(0).poses);
  check_layouts(kitchen.name, tables);
  for (size_t i = 0; i < tables.size(); ++i) {
    layouts.push_back(
        std::make_unique<const PlannedLayout>(concat(kitchen.name, ", layout ", i), std::move(tables[i])));
    check_layout(int(i));
  }
}

int32_t RecordedKitchens::Prepared::row_of(int layout, int doors, int pose, int hand) const {
  const size_t poses = layouts[0]->tables.poses.size();
  return kitchen.view[((size_t(layout) * kDoorStates + size_t(doors)) * poses + size_t(pose)) * kHands + size_t(hand)];
}

void RecordedKitchens::Prepared::check_layout(int layout) const {
  const PlannedLayout& planned = *layouts[size_t(layout)];
  const std::vector<bool> reached = kitchen_reachable(planned.tables, kOwnSlots);
  const int poses = planned.tables.pose_count();
  KitchenState state;
  state.slots = kOwnSlots;
  for (int doors = 0; doors < kDoorStates; ++doors)
    for (int pose = 0; pose < poses; ++pose) {
      const auto where = [&] {
        return concat(kitchen.name, ", layout ", layout, ": from ", text_of(planned.tables.poses[size_t(pose)]),
                      ", doors ", doors);
      };
      const size_t first = (size_t(doors) * size_t(poses) + size_t(pose)) * kHands;
      for (int hand = 0; hand < kHands; ++hand)
        if (reached[first + size_t(hand)] && row_of(layout, doors, pose, hand) < 0)
          fail(Exit::kData, where(), ", object in the hand ", hand,
               ": found no features, expected some where an episode can come by");
      if (!reached[first + kEmptyHand]) continue;
      state.pose = uint16_t(pose);
      state.doors = uint8_t(doors);
      for (int object = 0; object < kKitchenObjects; ++object)
        if (!planned.planner.has_plan({object, kSink}, state))
          fail(Exit::kData, where(), ": the ", kKitchenObjectNames[object], " cannot be picked up");
    }
}

RecordedKitchens::RecordedKitchens(std::vector<RecordedKitchen> kitchens)
    : KitchenWorld(kitchens.empty() ? "" : kitchens.front().extractor) {
  for (RecordedKitchen& kitchen : kitchens) {
    const std::string source = kitchen.source;
    try {
      add_environment({kitchen.name, kitchen.hash, ""});
      if (kitchen.extractor != extractor())
        fail(Exit::kData, kitchen.name, ": found features of ", quoted(kitchen.extractor), ", expected ",
             quoted(extractor()), " as of ", environments()[0].name);
      all_.push_back(std::make_shared<const Prepared>(std::move(kitchen)));
    } catch (const Error& error) {
      throw source.empty() ? error : error.at("cannot read " + source + ": ");
    }
  }
}

RecordedKitchens::RecordedKitchens(const RecordedKitchens& from, const std::vector<int>& envs)
    : KitchenWorld(from.extractor()) {
  for (const int env : envs) {
    add_environment(from.environments()[size_t(env)]);
    all_.push_back(from.all_[size_t(env)]);
  }
}

WorldState RecordedKitchens::reset(int env, Random& random) const {
  KitchenState state;
  state.layout = uint16_t(random.below(uint32_t(layouts(env))));
  const std::vector<uint16_t>& starts = tables(env, 0).start_poses;
  state.pose = starts[random.below(uint32_t(starts.size()))];
  state.slots = kOwnSlots;
  return pack(state);
}

bool RecordedKitchens::valid(EnvTask pair, const WorldState& state) const {
  const std::array<uint8_t, kKitchenObjects> slots = unpack(state).slots;
  for (size_t i = 0; i < kKitchenObjects; ++i)
    if (slots[i] != i && slots[i] != kNoSlot) return false;
  return KitchenWorld::valid(pair, state);
}

void RecordedKitchens::write_view(int env, const KitchenState& state, float* features) const {
  const Prepared& recorded = *all_[size_t(env)];
  const int32_t row = recorded.row_of(state.layout, state.doors, state.pose, state.hand);
  if (row < 0) {  // after the end of an episode
    std::fill_n(features, kViewFeatures, 0.0f);
  } else if (recorded.kitchen.halves) {
    const Half* halves = reinterpret_cast<const Half*>(recorded.kitchen.features.data()) + size_t(row) * kViewFeatures;
    for (int i = 0; i < kViewFeatures; ++i) features[i] = to_float(halves[i]);
  } else {
    std::memcpy(features, recorded.kitchen.features.data() + size_t(row) * kViewFeatures * sizeof(float),
                kViewFeatures * sizeof(float));
  }
}

void RecordedKitchens::place_objects(int env, const Places& places, KitchenState& state) const {
  const auto lies = [&](int layout, size_t object) {
    const KitchenCell& cell = tables(env, layout).slots[object];
    return cell.row == places[object].first && cell.column == places[object].second;
  };
  size_t most = 0;  // objects of a layout that lie as they should
  for (int layout = 0; layout < layouts(env); ++layout) {
    size_t object = 0;
    while (object < kKitchenObjects && lies(layout, object)) ++object;
    most = std::max(most, object);
    if (object < kKitchenObjects) continue;
    state.layout = uint16_t(layout);
    state.slots = kOwnSlots;
    return;
  }
  fail(Exit::kData, "'", kKitchenObjectNames[most], "': found row ", places[most].first, ", column ",
       places[most].second, ", where it lies in no layout with the other objects");
}

}  // namespace synpo
