#include "draw/kitchen/kitchen_agent_view.h"

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/key.h"
#include "draw/colour.h"
#include "draw/episode/history_row.h"
#include "draw/kitchen/kitchen_moment.h"

namespace synpo {
namespace {

constexpr double kHighPt = 240, kWidePt = 300, kMostCellPt = 20, kBetweenPt = 20, kMarginPt = 12, kTextPt = 9;

std::string title_words(const KitchenMoment& moment) {
  return concat(moment.world.environments()[size_t(moment.pair.env)].name, ", task ",
                kitchen_task(moment.pair.task).name(), ", step ", moment.history.now().steps);
}

std::string caption_words(const KitchenMoment& moment, const KitchenPose& pose, int hand) {
  static const char* const kHeadings[] = {"up", "right", "down", "left"};
  const std::string next = moment.expert_action < 0
                               ? "success"
                               : concat("the expert's next action: ", kKitchenActionNames[moment.expert_action]);
  const std::string looks =
      pose.horizon == 0 ? "level" : concat(std::abs(pose.horizon), "\u00b0 ", pose.horizon > 0 ? "down" : "up");
  const std::string holds = hand == kEmptyHand ? "nothing" : concat("the ", kKitchenObjectNames[hand]);
  return concat(next, "; the agent faces ", kHeadings[pose.heading / 90], " in the plan, looks ", looks, " and holds ",
                holds);
}

std::vector<KeyEntry> key_entries(KitchenTask task, const KitchenState& now) {
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

}  // namespace

KitchenMoment kitchen_moment(const KitchenSet& world, EnvTask pair, Random random, int64_t steps) {
  KitchenMoment moment = {world, pair, {}, -1};
  WorldState state = world.reset(pair.env, random);
  const int length = world.planner(pair.env).steps_to_success(kitchen_task(pair.task), unpack(state));
  if (steps > length) fail(Exit::kUsage, "the expert's episode ends after ", length, " steps, before step ", steps);
  moment.history.push(state);
  for (int64_t i = 0; i < steps; ++i) {
    world.step(pair, state, world.expert(pair, state));
    moment.history.push(state);
  }
  if (steps < length) moment.expert_action = world.expert(pair, state);
  return moment;
}

Canvas draw_kitchen_view(const KitchenMoment& moment, const KitchenViewStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int env = moment.pair.env;
  const KitchenTask task = kitchen_task(moment.pair.task);
  const Kitchen kitchen = kitchen_of(moment.world, env);
  const KitchenScene& scene = moment.world.scene(env);
  const KitchenFrame now = moment.world.frame(env, moment.history.now());
  const KitchenState state = unpack(moment.history.now());

  const int cell = px(std::min({kMostCellPt, kHighPt / kitchen.rows, kWidePt / kitchen.columns}));
  const int high = std::max(px(kHighPt), kitchen.rows * cell), between = px(kBetweenPt), margin = px(kMarginPt);
  const int text = px(kTextPt), heading = text + px(8);
  const std::string plan_title = "(a) the kitchen from above";
  const int plan_width = std::max(kitchen.columns * cell, font.width(plan_title, text)),
            inside = plan_width + between + high;

  const HistoryRow row(inside, kSmallView, px);
  const std::string small_title =
      style.history ? "(c) the last four pictures of 32 x 32 pixels, of which the network has the features"
                    : "(c) the 32 x 32 pixels of which the network has the features";
  const int small = std::max(1, px(110) / kSmallView) * kSmallView;
  const int key_x = style.history ? margin : margin + small + between;
  const Key key(key_entries(task, state), margin + inside - key_x, style.scale, font);
  const Heading title(style.title.empty() ? title_words(moment) : style.title,
                      caption_words(moment, now.eye, state.hand), inside, style.scale, font);
  const int headings_y = margin + title.height() + px(2), panels_y = headings_y + heading,
            small_y = panels_y + high + px(14);
  const int key_y = style.history ? small_y + row.height() + px(14) : small_y + heading;
  const int bottom = style.history ? key_y + key.height() : key_y + std::max(key.height(), small);
  Canvas canvas(inside + 2 * margin, bottom + margin, font);

  title.draw(canvas, margin, margin);
  const int seen_x = margin + plan_width + between;
  canvas.text(margin, headings_y, plan_title, text, kSoftInk);
  canvas.text(seen_x, headings_y, "(b) what the agent sees, 60\u00b0 each way", text, kSoftInk);
  const PlanGrid place = {margin + (plan_width - kitchen.columns * cell) / 2,
                          panels_y + (high - kitchen.rows * cell) / 2, cell, kitchen.columns};
  draw_moment(canvas, place, kitchen, now, task.object);
  draw_kitchen_seen(canvas, {seen_x, panels_y, high, high}, scene, now);
  if (style.history) {
    row.draw(canvas, margin, small_y, small_title, moment.history.count, [&](const Box& box, int i, bool missing) {
      const KitchenFrame frame = missing ? KitchenFrame() : moment.world.frame(env, moment.history.states[size_t(i)]);
      draw_small_seen(canvas, box, scene, missing ? nullptr : &frame);
    });
  } else {
    canvas.text(margin, small_y, small_title, text, kSoftInk);
    draw_small_seen(canvas, {margin, small_y + heading, small, small}, scene, &now);
  }
  key.draw(canvas, key_x, key_y);
  return canvas;
}

}  // namespace synpo
