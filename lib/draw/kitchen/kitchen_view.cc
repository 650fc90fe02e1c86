// A moment in a kitchen: from above, as the agent sees it, and what the network's features are made of.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/key.h"
#include "draw/face/film.h"
#include "draw/face/plan_grid.h"
#include "draw/face/world_face.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/kitchen/kitchen_face.h"
#include "draw/kitchen/kitchen_moment.h"
#include "draw/kitchen/kitchen_picture.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/kitchen_set.h"
#include "world/kitchen/rules.h"
#include "world/kitchen/view/view.h"
#include "world/world.h"

namespace synpo {

void KitchenFace::draw_seen(Canvas& canvas, const Box& box, const Film& film, int moment) const {
  draw_kitchen_seen(canvas, box, set_.solids(film.pair.env), frame(film, moment));
}

ViewPanels KitchenFace::view_panels(const Film&) const {
  return {.plan_title = "(a) the kitchen from above",
          .seen_title = "(b) what the agent sees, 60\u00b0 each way",
          .inputs_title = "(c) the last four pictures of 32 x 32 pixels, of which the network has the features",
          .input_title = "(c) the 32 x 32 pixels of which the network has the features"};
}

std::string KitchenFace::view_title(const Film& film) const { return concat(name(film.pair), ", step ", film.steps()); }

std::string KitchenFace::view_caption(const Film& film) const {
  static const char* const kHeadings[] = {"up", "right", "down", "left"};
  const KitchenPose eye = frame(film, film.steps()).eye;
  const int hand = unpack(film.states.back()).hand;
  const std::string looks =
      eye.horizon == 0 ? "level" : concat(std::abs(eye.horizon), "\u00b0 ", eye.horizon > 0 ? "down" : "up");
  const std::string holds = hand == kEmptyHand ? "nothing" : concat("the ", kKitchenObjectNames[hand]);
  return concat(next_words(film), "; the agent faces ", kHeadings[eye.heading / 90], " in the plan, looks ", looks,
                " and holds ", holds);
}

void KitchenFace::draw_moment(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const {
  const KitchenFrame now = frame(film, moment);
  draw_ground(canvas, place, film, moment, Shown::kMoment);
  draw_objects(canvas, place, kitchen(film), now, kitchen_task(film.pair.task).object);
  draw_looker(canvas, agent_box(place, kitchen(film), now.eye), now.eye.heading);
}

void KitchenFace::draw_input(Canvas& canvas, const Box& box, const Film& film, int moment) const {
  const KitchenFrame seen = moment < 0 ? KitchenFrame() : frame(film, moment);
  draw_small_seen(canvas, box, set_.solids(film.pair.env), moment < 0 ? nullptr : &seen);
}

std::vector<KeyEntry> KitchenFace::view_key(const Film& film) const {
  const KitchenTask task = kitchen_task(film.pair.task);
  const KitchenState now = unpack(film.states.back());
  const Sign agent = [](Canvas& canvas, const Box& box) { draw_looker(canvas, box, 0); };
  std::vector<KeyEntry> key = {{{agent}, "agent"}, {{draw_sight_sign}, "its sight, to 1.5 m"}};
  for (int i = 0; i < kKitchenObjects; ++i) {
    std::string name = kKitchenObjectNames[i];
    if (now.hand == i)
      name += " (in the hand)";
    else if (now.slots[size_t(i)] == kNoSlot)
      name += " (put)";
    else if (i == task.object)
      name += " (pick up)";
    key.push_back({{name.ends_with("(pick up)") ? wanted_sign(i) : object_sign(i)}, name});
  }
  for (int i = 0; i < kKitchenReceptacles; ++i)
    key.push_back(
        {{receptacle_sign(i)}, concat(kKitchenReceptacleNames[i], i == task.receptacle ? " (put there)" : "")});
  key.push_back({{colour_sign(kPaperCounter)}, "counter"});
  key.push_back({{colour_sign(kPaperTable)}, "table"});
  return key;
}

}  // namespace synpo
