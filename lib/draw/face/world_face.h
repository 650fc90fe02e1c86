// How a world is drawn: plans of its environments, an episode's way over them, what the agent sees, and the words for
// all of it. The pictures (draw/episode) are laid out once for all worlds and ask the world's face for what is in them.
//
// WorldFace itself is the face of a world that has no other: it has no plans, shows the pictures that the network is
// given where it is given any, and says all else in words. A world's own face overrides what it can do better. Which
// face a world has, draw/worlds/faces.h says.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/film.h"
#include "draw/face/plan_grid.h"
#include "draw/face/policy_stage.h"
#include "draw/map_style.h"
#include "draw/terminal/block_plans.h"
#include "draw/terminal/terminal.h"
#include "world/world.h"

namespace synpo {

// Names and features that the worlds of a face share.
struct FaceKind {
  const char *environment = "environment", *environments = "environments";
  const char* task_hint = nullptr;  // what a task's name is made of: "two of R B G O P, such as R-B"
  bool has_window = false;          // what is seen has a radius
  bool has_text = true;             // film_text()
  bool has_policy_picture = false;  // draw_policy()
};

// Cells of a plan; none where there is no plan.
struct PlanSize {
  int rows = 0, columns = 0;
};

// An episode is drawn as a whole, or as it stands at a moment.
enum class Shown { kWhole, kMoment };

// The panels of a moment: the plan, what the agent sees, and beneath them what the network gets.
struct ViewPanels {
  std::string plan_title, seen_title;
  std::string inputs_title;  // of its last pictures
  std::string input_title;   // of the last alone; empty: it is the one in the panel of what is seen
  double side_pt = 240;      // of what is seen, and at most the height of the plan
  double wide_pt = 300;      // at most the width of the plan
  double between_pt = 20;
};

class WorldFace {
 public:
  explicit WorldFace(std::shared_ptr<const World> world) : world_(std::move(world)) {}
  virtual ~WorldFace() = default;

  const World& world() const { return *world_; }
  virtual const FaceKind& kind() const;

  // Words of an episode. Actions are numbered from 0.

  // "map1, task R-B"
  std::string name(EnvTask pair) const;
  // "success", "timeout", "unfinished" where the actions end before the episode does, or what was wrong.
  virtual std::string outcome(const Film& film) const;
  // Says what action `i` did: "pick Mug"; its name where there is nothing more to say.
  virtual std::string action_words(const Film& film, int i) const;
  // "; R at step 20, B at step 41; 2 steps into walls": what describe() says after the outcome.
  virtual std::string deeds(const Film& film) const;
  // "success after 41 steps (39 would do), reward 11.60" and the deeds.
  std::string describe(const Film& film) const;
  // "the expert's next action: UP", or "success" after the end.
  std::string next_words(const Film& film) const;
  // A sign for what action `i` did; null where that is not worth a mark.
  virtual Sign event_sign(const Film& film, int i) const;
  // Actions: spread_moments() with those that have a sign.
  std::vector<int> key_moments(const Film& film, int count) const;

  // Plans.

  virtual PlanSize plan_size(int env) const;
  // The cell of the plan where the agent is.
  virtual int agent_cell(int env, const WorldState& state) const;
  // The environments with their names. Throws kUsage for none.
  virtual Canvas draw_plans(const std::vector<int>& envs, const MapStyle& style, const Font& font) const;
  virtual BlockPlan block_plan(int env) const;
  // The same on a terminal so many columns wide, as terminal_plans() lays them out.
  std::string plans_text(const std::vector<int>& envs, const MapStyle& style, TerminalColour colour, int width) const;

  // The way of an episode, up to a moment: the ground, the steps over it, the start, then things and agent.

  virtual void draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const;
  virtual void draw_steps(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const;
  virtual void draw_things(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const;
  // The cells whose counts draw_counts() writes: where the agent was at every moment.
  virtual std::vector<int> counted_cells(const Film& film, int moment) const;
  // `cell` pixels a cell.
  virtual std::vector<KeyEntry> way_key(const Film& film, int cell) const;
  // Whether that is long and stands beside the plan, an entry a line, or beneath it.
  virtual bool key_beside() const;
  // The path on a terminal, beginning with a line of the pair's name and ending with what describe() says.
  virtual std::string film_text(const Film& film, TerminalColour colour) const;

  // Pictures of what the agent sees.

  // The sides of its picture are a multiple of so many pixels.
  virtual int seen_unit() const;
  // Of itself the newest picture of the network's input, where that is made of pictures.
  virtual void draw_seen(Canvas& canvas, const Box& box, const Film& film, int moment) const;
  // Follows "what the agent saw" in a title.
  virtual std::string seen_words(const Film& film) const;

  // The last moment of an expert's film.

  virtual ViewPanels view_panels(const Film& film) const;
  // "map1, task R-B, step 5; the expert's next action: UP"
  virtual std::string view_title(const Film& film) const;
  // May be empty.
  virtual std::string view_caption(const Film& film) const;
  virtual void draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const;
  // The picture that the network gets of a moment, in boxes whose sides are a multiple of input_unit() pixels; -1: of
  // one before the start.
  virtual int input_unit() const;
  virtual void draw_input(Canvas& canvas, const Box& box, const Film& film, int moment) const;
  virtual std::vector<KeyEntry> view_key(const Film& film) const;

  // Tasks.

  // The order in which a picture shows them.
  virtual std::vector<int> task_order() const;
  // A sign of a task, and what it means; there may be none.
  virtual Sign task_sign(int task) const;
  virtual std::string task_sign_words() const;

  // Policies, where kind().has_policy_picture.

  // The stages of a task's episode from this start, without choices.
  virtual std::vector<PolicyStage> policy_stages(EnvTask pair, const WorldState& start) const;
  // The stages side by side.
  virtual Canvas draw_policy(EnvTask pair, const std::vector<PolicyStage>& stages, const PolicyPictureStyle& style,
                             const Font& font) const;

 protected:
  // Where the agent was at every moment up to this one.
  std::vector<int> agent_cells(const Film& film, int moment) const;

 private:
  bool shows_pictures() const;
  void draw_observation(Canvas& canvas, const Box& box, const Film& film, int moment) const;
  std::shared_ptr<const World> world_;
};

}  // namespace synpo
