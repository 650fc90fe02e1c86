// Kitchens as a world: 21 tasks, the rules over tables, their expert, and the layout of observations and starts. Where
// tables and features come from, KitchenSet (plans) and RecordedKitchens (files) say.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/planner.h"
#include "world/kitchen/rules.h"
#include "world/world.h"

namespace synpo {

class KitchenWorld : public World {
 public:
  WorldStep step(EnvTask pair, WorldState& state, int action) const override;
  int expert(EnvTask pair, const WorldState& state) const override;
  void action_values(EnvTask pair, const WorldState& state, int* cents) const override;
  bool at_choice(EnvTask pair, const WorldState& state) const override;

  // Features, and the number of the object that is in the hand now, kEmptyHand for none. `window` means nothing here.
  void observe(int env, const StateHistory& history, int window, uint8_t* observation) const override;

  // "agent": row, column; "view": heading, horizon in degrees; and each object's name: row, column.
  StartPlaces start_places(int env, const WorldState& start) const override;
  WorldState start_state(int env, const StartPlaces& places) const override;
  bool valid(EnvTask pair, const WorldState& state) const override;

 protected:
  explicit KitchenWorld(const std::string& extractor);

  // The tables of a layout and the planner over them, in one place in memory as it holds on to them.
  struct PlannedLayout {
    PlannedLayout(const std::string& name, KitchenTables all) : tables(std::move(all)), planner(name, tables) {}
    PlannedLayout(const PlannedLayout&) = delete;
    KitchenTables tables;
    KitchenPlanner planner;
  };

  virtual int layouts(int env) const = 0;
  virtual const PlannedLayout& planned(int env, int layout) const = 0;
  // Writes the features [kViewFeatures] of what is seen of a state.
  virtual void write_view(int env, const KitchenState& state, float* features) const = 0;
  // Layout and slots of the objects of a start, which lie at these rows and columns. Throws kData where no episode
  // starts so.
  using Places = std::array<std::pair<int, int>, kKitchenObjects>;
  virtual void place_objects(int env, const Places& places, KitchenState& state) const = 0;

 private:
  const PlannedLayout& planned_for(int env, const KitchenState& state) const { return planned(env, state.layout); }
};

}  // namespace synpo
