// The kitchens' face: plans with furniture and objects, the agent's looks, and what it did to things.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/film.h"
#include "draw/face/plan_grid.h"
#include "draw/face/world_face.h"
#include "draw/map_style.h"
#include "draw/terminal/block_plans.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/view/view.h"
#include "world/world.h"

namespace synpo {

// The effect of an action on a thing: an object for kPicked, else a receptacle.
enum class Deed : uint8_t { kNone, kOpened, kClosed, kPicked, kPut };
struct KitchenEvent {
  Deed deed = Deed::kNone;
  int thing = -1;
};

class KitchenFace : public WorldFace {
 public:
  explicit KitchenFace(const std::shared_ptr<const KitchenSet>& world);

  static const FaceKind kKind;
  const FaceKind& kind() const override { return kKind; }

  // Of action number `i`, from 0.
  KitchenEvent event(const Film& film, int i) const;

  std::string outcome(const Film& film) const override;
  std::string action_words(const Film& film, int i) const override;
  std::string deeds(const Film& film) const override;
  Sign event_sign(const Film& film, int i) const override;

  PlanSize plan_size(int env) const override;
  int agent_cell(int env, const WorldState& state) const override;
  Canvas draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const override;
  BlockPlan block_plan(int env) const override;

  void draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const override;
  // With an arrowhead where it turns.
  void draw_steps(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const override;
  void draw_things(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const override;
  // The cells that the agent came to: turning is no passage.
  std::vector<int> counted_cells(const Film& film, int moment) const override;
  std::vector<KeyEntry> way_key(const Film& film, int cell) const override;
  bool key_beside() const override { return true; }

  void draw_seen(Canvas& canvas, const Box& box, const Film& film, int moment) const override;

  ViewPanels view_panels(const Film& film) const override;
  std::string view_title(const Film& film) const override;
  std::string view_caption(const Film& film) const override;
  void draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const override;
  int input_unit() const override { return kSmallView; }
  void draw_input(Canvas& canvas, const Box& box, const Film& film, int moment) const override;
  std::vector<KeyEntry> view_key(const Film& film) const override;

 private:
  const Kitchen& kitchen(const Film& film) const { return kitchens_[size_t(film.pair.env)]; }
  KitchenFrame frame(const Film& film, int moment) const;
  Box object_place(const PlanGrid& place, const Film& film, int object) const;
  const KitchenSet& set_;
  std::vector<Kitchen> kitchens_;
};

}  // namespace synpo
