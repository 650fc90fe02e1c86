// The kitchens as a world: environments, 21 tasks, their expert and what the agent sees.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "world/kitchen_features.h"
#include "world/kitchen_geometry.h"
#include "world/kitchen_planner.h"
#include "world/world.h"

namespace synpo {

class KitchenSet : public World {
 public:
  // Throws kData for two kitchens of one name, or one in which a task cannot be done.
  explicit KitchenSet(const std::vector<Kitchen>& kitchens);
  // The nineteen that are built in.
  KitchenSet();

  const std::string& name() const override;
  int rules() const override { return kKitchenRules; }
  int step_limit() const override { return kKitchenStepLimit; }
  const std::vector<Environment>& environments() const override { return environments_; }
  const std::vector<std::string>& task_names() const override;
  const std::vector<std::string>& action_names() const override;
  int moves() const override { return kKitchenMoves; }

  WorldState reset(int env, Random& random) const override;
  WorldStep step(EnvTask pair, WorldState& state, int action) const override;
  int expert(EnvTask pair, const WorldState& state) const override;
  void action_values(EnvTask pair, const WorldState& state, int* cents) const override;
  bool at_choice(EnvTask pair, const WorldState& state) const override;

  Sight sight() const override { return Sight::kFeatures; }
  size_t observation_size() const override { return kKitchenObservation * sizeof(float); }
  // float [kHistory, kViewFeatures] of the views, oldest first and zero where there is none, then kHandFloats, of which the first is the number of the
  // object in the hand now, kEmptyHand for none; the rest is zero. `window` means nothing here.
  void observe(int env, const StateHistory& history, int window, uint8_t* observation) const override;

  // "agent": row, column; "view": heading, horizon in degrees; and each object's name: row, column.
  StartPlaces start_places(int env, const WorldState& start) const override;
  WorldState start_state(int env, const StartPlaces& places) const override;
  bool valid(EnvTask pair, const WorldState& state) const override;

  const KitchenScene& scene(int env) const { return rooms_[size_t(env)]->scene; }
  const KitchenTables& tables(int env) const { return rooms_[size_t(env)]->tables; }
  const KitchenPlanner& planner(int env) const { return rooms_[size_t(env)]->planner; }
  // What of a state can be seen.
  KitchenFrame frame(int env, const WorldState& state) const;

 private:
  // In one place in memory, as the planner holds on to the tables.
  struct Room {
    explicit Room(const Kitchen& kitchen) : scene(kitchen), tables(kitchen_tables(kitchen, scene)), planner(kitchen.name, tables) {}
    KitchenScene scene;
    KitchenTables tables;
    KitchenPlanner planner;
  };
  std::vector<Environment> environments_;
  std::vector<std::unique_ptr<const Room>> rooms_;
};

}  // namespace synpo
