#include "draw/grid/policy_picture.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/key.h"
#include "draw/colour.h"
#include "draw/face/plan_grid.h"
#include "draw/grid/maze_picture.h"
#include "stats/report/text_table.h"
#include "world/grid/gridworld.h"

namespace synpo {
namespace {

constexpr double kCellPt = 19, kBetweenPt = 20, kMarginPt = 12;
constexpr Rgb kWrongGround = {255, 222, 199};
constexpr double kLeast = 1.0 / kGridActions;  // no best action is less probable

Point direction_of(int action) {
  constexpr Point kDirections[] = {{0, -1}, {0, 1}, {-1, 0}, {1, 0}};
  return kDirections[action];
}

Rgb action_colour(bool agrees, double probability) {
  const Scheme& safe = find_scheme("safe");
  return ramp_colour(agrees ? safe.seen : safe.unseen, 0.2 + 0.65 * (probability - kLeast) / (1 - kLeast));
}

// An arrow over most of the box; for PICK a disc.
void draw_action(Canvas& canvas, const Box& box, int action, Rgb colour) {
  const Point centre = box.centre();
  const double side = box.width;
  if (action == kPick) {
    canvas.disc(centre, 0.28 * side, colour);
    return;
  }
  const Point d = direction_of(action);
  const auto at = [&](double along, double across) {
    return Point{centre.x + (d.x * along - d.y * across) * side, centre.y + (d.y * along + d.x * across) * side};
  };
  canvas.polygon({at(-0.34, 0.06), at(0.06, 0.06), at(0.06, -0.06), at(-0.34, -0.06)}, colour);
  canvas.polygon({at(0.36, 0), at(0, 0.23), at(0, -0.23)}, colour);
}

// A bar at the border that an optimal action leads across; for PICK a ring.
void draw_optimal(Canvas& canvas, const Box& box, int action) {
  const Point centre = box.centre();
  const double side = box.width;
  if (action == kPick) {
    canvas.disc(centre, 0.45 * side, kInk);
    canvas.disc(centre, 0.38 * side, kWrongGround);
    return;
  }
  const Point d = direction_of(action);
  const double along = 0.43 * side, length = 0.22 * side, half = 0.05 * side;
  const double x = centre.x + d.x * along, y = centre.y + d.y * along;
  const double dx = d.x != 0 ? half : length, dy = d.y != 0 ? half : length;
  canvas.polygon({{x - dx, y - dy}, {x + dx, y - dy}, {x + dx, y + dy}, {x - dx, y + dy}}, kInk);
}

void draw_treasure_frame(Canvas& canvas, const Box& box, int treasure) {
  canvas.frame(box, std::max(2, box.width / 8), kPaperTreasures[treasure]);
}

void draw_treasure_letter(Canvas& canvas, const Box& box, int treasure) {
  const int size = box.width * 2 / 5;
  const Box corner = {box.x, box.y, size, size};
  if (size < 6) return;
  canvas.fill(corner, kPaperTreasures[treasure]);
  canvas.text(corner.x + size / 2, corner.y + size / 2, std::string(1, kTreasureLetters[treasure]), size * 4 / 5,
              ink_on(kPaperTreasures[treasure]), Across::kCentre, Upright::kMiddle);
}

// Where the agent stands means nothing.
GridState state_of(const PolicyStage& stage) { return to_grid_state(stage.states.front()); }

void draw_stage(Canvas& canvas, const PlanGrid& place, const Maze& maze, const PolicyStage& stage) {
  draw_maze(canvas, place.x, place.y, place.cell, maze);
  const int line = std::max(1, place.cell / 16);
  const auto for_cells = [&](auto draw) {
    for (size_t i = 0; i < stage.states.size(); ++i)
      draw(place.box(to_grid_state(stage.states[i]).now.agent), stage.choices[i]);
  };
  const auto on_treasures = [&](auto draw) {
    for (int i = 0; i < kTreasures; ++i)
      if (const uint8_t at = state_of(stage).now.treasures[i]; at != kPicked) draw(canvas, place.box(at), i);
  };
  for_cells([&](const Box& box, const PolicyChoice& choice) {
    if (!choice.agrees()) canvas.fill({box.x + line, box.y + line, box.width - line, box.height - line}, kWrongGround);
  });
  on_treasures(draw_treasure_frame);
  for_cells([&](const Box& box, const PolicyChoice& choice) {
    for (int action = 0; action < kGridActions && !choice.agrees(); ++action)
      if (choice.optimal[size_t(action)]) draw_optimal(canvas, box, action);
    draw_action(canvas, box, choice.action, action_colour(choice.agrees(), choice.probability));
  });
  on_treasures(draw_treasure_letter);
}

std::string stage_text(const Task& task, const PolicyStage& stage) {
  const int cells = int(stage.states.size()), agreeing = stage.agreeing();
  const GridState state = state_of(stage);
  return concat("stage ", state.picked + 1, ", to ", kTreasureNames[next_target(task, state)], ": optimal in ",
                agreeing, " of ", cells, " cells (", percent(double(agreeing) / cells), " %)");
}

Key make_key(const std::vector<PolicyStage>& stages, int width, double scale, const Font& font) {
  const auto arrows = [](bool agrees) {
    std::vector<Sign> signs;
    for (const double probability : {0.4, 0.7, 1.0})
      signs.push_back([=](Canvas& canvas, const Box& box) {
        if (!agrees) canvas.fill(box, kWrongGround);
        draw_action(canvas, box, kRight, action_colour(agrees, probability));
      });
    return signs;
  };
  const bool all_agree = std::all_of(stages.begin(), stages.end(),
                                     [](const PolicyStage& s) { return s.agreeing() == int(s.states.size()); });
  std::vector<KeyEntry> entries = {{arrows(true), "best action is optimal; probability 0.4, 0.7, 1"}};
  if (!all_agree) entries.push_back({arrows(false), "not optimal"});
  entries.push_back(
      {{[](Canvas& canvas, const Box& box) { draw_action(canvas, box, kPick, action_colour(true, 1)); }}, "PICK"});
  if (!all_agree) {
    entries.push_back(
        {{[](Canvas& canvas, const Box& box) { draw_optimal(canvas, box, kRight); }}, "optimal: across this side"});
    entries.push_back({{[](Canvas& canvas, const Box& box) { draw_optimal(canvas, box, kPick); }}, "optimal: PICK"});
  }
  return Key(entries, width, scale, font);
}

}  // namespace

Canvas draw_maze_policy(const Maze& maze, const Task& task, const std::vector<PolicyStage>& stages,
                        const PolicyPictureStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), cell = px(kCellPt), side = kGridSide * cell, between = px(kBetweenPt),
            title = px(kPanelTitlePt);
  const int count = int(stages.size()), inside = count * side + (count - 1) * between;
  const Heading heading(style.title, style.caption, inside, style.scale, font);
  const Key key = make_key(stages, inside, style.scale, font);
  const int titles_y = margin + heading.height() + px(2), y = titles_y + title + px(6), key_y = y + side + px(12);
  Canvas canvas(inside + 2 * margin, key_y + key.height() + margin, font, style.scale);
  heading.draw(canvas, margin, margin);
  for (int i = 0; i < count; ++i) {
    const PlanGrid place = maze_grid(margin + i * (side + between), y, cell);
    canvas.text(place.x, titles_y, font.fitted(stage_text(task, stages[i]), title, side), title, kInk);
    draw_stage(canvas, place, maze, stages[i]);
  }
  key.draw(canvas, margin, key_y);
  return canvas;
}

}  // namespace synpo
