#include "world/kitchen/kitchen_set.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/hash.h"
#include "world/kitchen/builtin_kitchens.h"
#include "world/kitchen/view/features.h"

namespace synpo {

KitchenSet::KitchenSet(const std::vector<Kitchen>& kitchens)
    : KitchenWorld(kExtractorName + ('@' + hex(extractor_hash()))) {
  for (const Kitchen& kitchen : kitchens) {
    add_environment({kitchen.name, kitchen.hash, kitchen.text});
    plans_.push_back(std::make_unique<const Plan>(kitchen));
  }
}

KitchenSet::KitchenSet() : KitchenSet(builtin_kitchens()) {}

WorldState KitchenSet::reset(int env, Random& random) const { return pack(kitchen_reset(tables(env), random)); }

KitchenFrame KitchenSet::frame(int env, const WorldState& state) const {
  const KitchenState at = unpack(state);
  const KitchenTables& all = tables(env);
  KitchenFrame frame;
  frame.eye = all.poses[at.pose];
  frame.doors = at.doors;
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    if (at.slots[i] == kNoSlot) continue;
    const KitchenCell& slot = all.slots[at.slots[i]];
    frame.objects[i] = int16_t(ray_cell(slot.row, slot.column));
  }
  return frame;
}

void KitchenSet::write_view(int env, const KitchenState& state, float* features) const {
  std::memcpy(features, view_features(solids(env), frame(env, pack(state))), kViewFeatures * sizeof(float));
}

void KitchenSet::place_objects(int env, const Places& places, KitchenState& state) const {
  const std::vector<KitchenCell>& slots = tables(env).slots;
  for (size_t i = 0; i < kKitchenObjects; ++i) {
    const auto [row, column] = places[i];
    const std::string where = concat("'", kKitchenObjectNames[i], "': found row ", row, ", column ", column, ", ");
    const KitchenCell wanted = {int16_t(row), int16_t(column)};
    const auto slot =
        wanted.row == row && wanted.column == column ? std::find(slots.begin(), slots.end(), wanted) : slots.end();
    if (slot == slots.end()) fail(Exit::kData, where, "where no object can lie");
    state.slots[i] = uint8_t(slot - slots.begin());
    if (std::find(state.slots.begin(), state.slots.begin() + int(i), state.slots[i]) != state.slots.begin() + int(i))
      fail(Exit::kData, where, "where another object lies");
  }
}

}  // namespace synpo
