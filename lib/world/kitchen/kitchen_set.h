// Kitchens from plans: the objects lie on any slots, and what the agent sees is drawn and made into features on the
// way.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "base/random.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/make_tables.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/kitchen_world.h"
#include "world/kitchen/planner.h"
#include "world/kitchen/rules.h"
#include "world/kitchen/view/view.h"
#include "world/world.h"

namespace synpo {

class KitchenSet : public KitchenWorld {
 public:
  // Throws kData for two kitchens of one name, or one in which a task cannot be done.
  explicit KitchenSet(const std::vector<Kitchen>& kitchens);
  // The nineteen that are built in.
  KitchenSet();

  WorldState reset(int env, Random& random) const override;

  const KitchenSolids& solids(int env) const { return plans_[size_t(env)]->solids; }
  const KitchenTables& tables(int env) const { return plans_[size_t(env)]->planned.tables; }
  const KitchenPlanner& planner(int env) const { return plans_[size_t(env)]->planned.planner; }
  // The part of a state that can be seen.
  KitchenFrame frame(int env, const WorldState& state) const;

 protected:
  int layouts(int) const override { return 1; }
  const PlannedLayout& planned(int env, int) const override { return plans_[size_t(env)]->planned; }
  void write_view(int env, const KitchenState& state, float* features) const override;
  void place_objects(int env, const Places& places, KitchenState& state) const override;

 private:
  struct Plan {
    explicit Plan(const Kitchen& kitchen) : solids(kitchen), planned(kitchen.name, kitchen_tables(kitchen, solids)) {}
    KitchenSolids solids;
    PlannedLayout planned;
  };
  std::vector<std::unique_ptr<const Plan>> plans_;
};

}  // namespace synpo
