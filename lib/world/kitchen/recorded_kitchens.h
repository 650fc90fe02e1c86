// Kitchens from files: the objects lie in one of some layouts, and what the agent sees from everywhere is known
// beforehand. In each layout object i is slot i of that layout's tables.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/random.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/kitchen_world.h"
#include "world/kitchen/planner.h"
#include "world/kitchen/rules.h"
#include "world/world.h"

namespace synpo {

struct RecordedKitchen {
  std::string name;
  uint64_t hash = 0;
  std::string extractor;               // World::extractor()
  std::vector<KitchenTables> layouts;  // alike but for slots and sight
  // [layouts, doors, poses, kKitchenObjects + 1]: the row of the features, by the object in the hand, kEmptyHand for
  // none; -1 where there is none.
  std::vector<int32_t> view;
  bool halves = true;       // features are Half, else float
  std::string features;     // [rows, kViewFeatures], as in memory
  std::string source = "";  // where it was read, for messages
};

class RecordedKitchens : public KitchenWorld {
 public:
  // Tables and rows are in range. Throws kData for two kitchens of one name or of different extractors, poses or
  // layouts that are alike, an object or a receptacle that cannot be used from everywhere, and a view that an episode
  // comes by and that has no features.
  explicit RecordedKitchens(std::vector<RecordedKitchen> kitchens);
  // Some of the environments of another one, in this order; the features are shared.
  RecordedKitchens(const RecordedKitchens& from, const std::vector<int>& envs);

  // A layout and a start pose, all alike likely; doors closed, hand empty.
  WorldState reset(int env, Random& random) const override;
  bool valid(EnvTask pair, const WorldState& state) const override;

  const KitchenTables& tables(int env, int layout) const { return planned(env, layout).tables; }
  const KitchenPlanner& planner(int env, int layout) const { return planned(env, layout).planner; }

 protected:
  int layouts(int env) const override { return int(all_[size_t(env)]->layouts.size()); }
  const PlannedLayout& planned(int env, int layout) const override {
    return *all_[size_t(env)]->layouts[size_t(layout)];
  }
  void write_view(int env, const KitchenState& state, float* features) const override;
  void place_objects(int env, const Places& places, KitchenState& state) const override;

 private:
  struct Prepared {
    explicit Prepared(RecordedKitchen from);
    void check_layout(int layout) const;
    int32_t row_of(int layout, int doors, int pose, int hand) const;
    RecordedKitchen kitchen;  // without the layouts
    std::vector<std::unique_ptr<const PlannedLayout>> layouts;
  };
  std::vector<std::shared_ptr<const Prepared>> all_;
};

}  // namespace synpo
