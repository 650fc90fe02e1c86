// GridWorld's face: mazes, treasures and what the agent sees of them.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/film.h"
#include "draw/face/plan_grid.h"
#include "draw/face/policy_stage.h"
#include "draw/face/world_face.h"
#include "draw/map_style.h"
#include "draw/terminal/block_plans.h"
#include "draw/terminal/terminal.h"
#include "world/grid/grid_set.h"
#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"
#include "world/world.h"

namespace synpo {

class GridFace : public WorldFace {
 public:
  explicit GridFace(const std::shared_ptr<const GridSet>& world) : WorldFace(world), grid_(*world) {}

  static const FaceKind kKind;
  const FaceKind& kind() const override { return kKind; }

  std::string outcome(const Film& film) const override;
  std::string action_words(const Film& film, int i) const override;
  std::string deeds(const Film& film) const override;
  Sign event_sign(const Film& film, int i) const override;

  PlanSize plan_size(int) const override { return {kGridSide, kGridSide}; }
  int agent_cell(int, const WorldState& state) const override { return to_grid_state(state).now.agent; }
  Canvas draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const override;
  BlockPlan block_plan(int env) const override;

  void draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const override;
  void draw_things(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const override;
  std::vector<KeyEntry> way_key(const Film& film, int cell) const override;
  // Three or four columns a cell: at every cell the last step that led there. With colours the cells are blocks, darker
  // towards the end; without them walls are ####.
  std::string film_text(const Film& film, TerminalColour colour) const override;

  std::string seen_words(const Film& film) const override;

  ViewPanels view_panels(const Film& film) const override;
  void draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const override;
  std::vector<KeyEntry> view_key(const Film& film) const override;

  std::vector<int> task_order() const override;
  Sign task_sign(int task) const override;
  std::string task_sign_words() const override;

  // To the first treasure, with one picture in memory as at the start of an episode, and to the second, with all: no
  // episode begins there.
  std::vector<PolicyStage> policy_stages(EnvTask pair, const WorldState& start) const override;
  Canvas draw_policy(EnvTask pair, const std::vector<PolicyStage>& stages, const PolicyPictureStyle& style,
                     const Font& font) const override;

 private:
  const Maze& maze(const Film& film) const { return grid_.maze(film.pair.env); }
  const Task& task(const Film& film) const { return grid_.tasks()[size_t(film.pair.task)]; }
  const GridSet& grid_;
};

// The treasure that action number `i`, from 0, picks; -1 where it picks none.
int treasure_picked(const Film& film, int i);

}  // namespace synpo
