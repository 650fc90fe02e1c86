#include "draw/kitchen/kitchen_episode_picture.h"

#include <algorithm>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/stroke.h"
#include "draw/colour.h"
#include "draw/episode/film_strip.h"
#include "draw/episode/path.h"
#include "draw/episode/time_bar.h"
#include "draw/kitchen/kitchen_moment.h"

namespace synpo {
namespace {

constexpr double kSidePt = 330, kMostCellPt = 20, kFrameSidePt = 208, kMarginPt = 12, kTextPt = 9, kLeastStripPt = 380;
constexpr int kStripColumns = 6;
constexpr Rgb kWrong = {200, 0, 0};

// Where the agent stood, up to a moment.
std::vector<int> cells_up_to(const KitchenFilm& film, int moment) {
  std::vector<int> cells;
  for (int i = 0; i <= moment; ++i) {
    const KitchenPose eye = film.frame(i).eye;
    cells.push_back(plan_cell(film.kitchen, eye.row, eye.column));
  }
  return cells;
}

// The cells that it came to: turning is no passage.
std::vector<int> passages(std::vector<int> cells) {
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

Point middle_of(const Box& box) { return {box.x + box.width / 2.0, box.y + box.height / 2.0}; }

void draw_start(Canvas& canvas, const Box& box) {
  canvas.disc(middle_of(box), box.width * 0.34, kPaperAgent);
  canvas.disc(middle_of(box), box.width * 0.22, kPaper);
}

// Where it turns, an arrowhead towards the new heading.
void draw_turns(Canvas& canvas, const PlanGrid& place, const KitchenFilm& film, int moment) {
  for (int i = 0; i < moment; ++i) {
    const KitchenPose from = film.frame(i).eye, to = film.frame(i + 1).eye;
    if (from.heading == to.heading) continue;
    const Point centre = place.centre(plan_cell(film.kitchen, to.row, to.column));
    const Point ahead = {double(kColumnStep[to.heading / 90]), double(kRowStep[to.heading / 90])};
    const double cell = place.cell;
    const auto tip = [&](double share) {
      return Point{centre.x + ahead.x * share * cell, centre.y + ahead.y * share * cell};
    };
    draw_arrowhead(canvas, tip(0.49), ahead, 0.33 * cell, paper_floor(film.kitchen.hash)[0]);
    draw_arrowhead(canvas, tip(0.46), ahead, 0.26 * cell, step_colour(i + 1, film.steps()));
  }
}

void draw_turn_sign(Canvas& canvas, const Box& box) {
  draw_arrowhead(canvas, {box.x + box.width / 2.0, box.y + 0.2 * box.height}, {0, -1}, 0.6 * box.height,
                 time_colour(0.5));
}

void draw_line(Canvas& canvas, Point from, Point to, double width, const Dash& dash, Rgb colour) {
  canvas.paint(stroke_mask({from, to}, width, dash, {0, 0, canvas.width(), canvas.height()}), colour);
}

// From where the agent stood to what it opened, took or filled.
void draw_grasp(Canvas& canvas, Point from, Point to, double cell, Rgb colour) {
  const double line = std::max(1.5, 0.1 * cell);
  draw_line(canvas, from, to, 1.8 * line, {}, kPaper);
  draw_line(canvas, from, to, line, {0.22 * cell, 0.2 * cell}, kPaperAgent);
  canvas.disc(from, 0.2 * cell, kPaperAgent);
  canvas.disc(from, 0.13 * cell, colour);
}

void draw_grasp_sign(Canvas& canvas, const Box& box) {
  const double y = box.y + box.height / 2.0;
  draw_grasp(canvas, {box.x + 0.2 * box.width, y}, {double(box.right()), y}, box.width, time_colour(0.5));
}

Box object_place(const PlanGrid& place, const KitchenFilm& film, int object) {
  const int cell = film.frame(0).objects[size_t(object)];
  return object_box(place, plan_cell(film.kitchen, cell / kSceneStride, cell % kSceneStride));
}

void ring_object(Canvas& canvas, const Box& box, int object, Rgb colour) {
  canvas.disc(middle_of(box), box.width * 0.66, colour);
  draw_object(canvas, box, object);
}

// Around the box, as what is open is dark.
void frame_receptacle(Canvas& canvas, const Box& box, int line, Rgb colour) {
  canvas.frame({box.x - line, box.y - line, box.width + 2 * line, box.height + 2 * line}, line, colour);
}

// The place of the box that is nearest to the agent.
Point nearest(const Box& box, Point to) {
  return {std::clamp(to.x, double(box.x), double(box.right())), std::clamp(to.y, double(box.y), double(box.bottom()))};
}

Sign ringed_object(int object, Rgb colour) {
  return [object, colour](Canvas& canvas, const Box& box) {
    const int inset = box.width / 7;
    ring_object(canvas, {box.x + inset, box.y + inset, box.width - 2 * inset, box.height - 2 * inset}, object, colour);
  };
}

Sign framed_receptacle(int receptacle, Rgb colour) {
  return [receptacle, colour](Canvas& canvas, const Box& box) {
    receptacle_sign(receptacle)(canvas, box);
    canvas.frame(box, std::max(2, box.width / 6), colour);
  };
}

Sign ring_sign(Rgb colour) {
  return [colour](Canvas& canvas, const Box& box) {
    canvas.disc(middle_of(box), box.width * 0.5, colour);
    canvas.disc(middle_of(box), box.width * 0.34, kPaper);
  };
}

Sign frame_sign(Rgb colour) {
  return [colour](Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 6), colour); };
}

Rgb colour_of_end(const KitchenFilm& film, int i) { return film.results[size_t(i)].wrong ? kWrong : kPaperAgent; }

// Plan, way, start, objects and what became of them, up to a moment.
void draw_way(Canvas& canvas, const PlanGrid& place, const KitchenFilm& film, int moment, bool with_sight) {
  const KitchenFrame now = film.frame(moment);
  const std::vector<int> cells = cells_up_to(film, moment);
  draw_kitchen(canvas, place, film.kitchen, now.doors, Lettering::kNames);
  if (with_sight) draw_sight(canvas, place, film.kitchen, now.eye);
  draw_path(canvas, place, cells, film.steps(), paper_floor(film.kitchen.hash)[0]);
  draw_turns(canvas, place, film, moment);
  draw_start(canvas, place.box(cells[0]));
  for (int i = 0; i < moment; ++i) {
    const KitchenEvent event = event_of(film, i);
    if (event.deed == Deed::kNone) continue;
    const Box target = event.deed == Deed::kPicked ? object_place(place, film, event.thing)
                                                   : receptacle_box(place, film.kitchen, event.thing);
    if (event.deed == Deed::kPut) frame_receptacle(canvas, target, std::max(2, place.cell / 6), colour_of_end(film, i));
    const Point from = place.centre(cells[size_t(i)]);
    draw_grasp(canvas, from, event.deed == Deed::kPicked ? middle_of(target) : nearest(target, from), place.cell,
               step_colour(i + 1, film.steps()));
  }
  draw_objects(canvas, place, film.kitchen, film.frame(0), film.task().object);
  for (int i = 0; i < moment; ++i)
    if (const KitchenEvent event = event_of(film, i); event.deed == Deed::kPicked)
      ring_object(canvas, object_place(place, film, event.thing), event.thing, colour_of_end(film, i));
  draw_looker(canvas, agent_box(place, film.kitchen, now.eye), now.eye.heading);
  draw_counts(canvas, place, passages(cells));
}

std::vector<TimeMark> event_marks(const KitchenFilm& film) {
  std::vector<TimeMark> marks;
  for (int i = 0; i < film.steps(); ++i) {
    const KitchenEvent event = event_of(film, i);
    if (event.deed == Deed::kPicked)
      marks.push_back({i + 1, ringed_object(event.thing, colour_of_end(film, i))});
    else if (event.deed == Deed::kPut)
      marks.push_back({i + 1, framed_receptacle(event.thing, colour_of_end(film, i))});
    else if (event.deed != Deed::kNone)
      marks.push_back({i + 1, receptacle_sign(event.thing)});
  }
  return marks;
}

std::vector<StripPicture> strip_pictures(const KitchenFilm& film, int64_t count) {
  std::vector<StripPicture> pictures;
  if (count == 0) return pictures;
  for (const int i : key_moments(film, int(count)))
    pictures.push_back({step_colour(i + 1, film.steps()), concat(i + 1, ": ", action_words(film, i)),
                        [&film, i](Canvas& canvas, const Box& box) {
                          draw_kitchen_seen(canvas, box, film.world.scene(film.pair.env), film.frame(i));
                        }});
  return pictures;
}

std::vector<KeyEntry> key_entries(const KitchenFilm& film, int cell) {
  const KitchenTask task = film.task();
  std::vector<KeyEntry> key = {
      {{draw_start}, "start"},
      {{[](Canvas& canvas, const Box& box) { draw_looker(canvas, box, 0); }}, "end, and its heading"},
      {{draw_turn_sign}, "turn to this heading"},
      {{draw_grasp_sign}, "opens, picks or puts"}};
  for (int i = 0; i < kKitchenObjects; ++i) {
    const bool wanted = i == task.object;
    key.push_back(
        {{wanted ? wanted_sign(i) : object_sign(i)}, concat(kKitchenObjectNames[i], wanted ? " (pick up)" : "")});
  }
  for (int i = 0; i < kKitchenReceptacles; ++i)
    key.push_back(
        {{receptacle_sign(i)}, concat(kKitchenReceptacleNames[i], i == task.receptacle ? " (put there)" : "")});
  for (int i = 0; i < film.steps(); ++i) {
    const Deed deed = event_of(film, i).deed;
    const bool wrong = film.results[size_t(i)].wrong;
    if (deed == Deed::kPicked)
      key.push_back({{ring_sign(colour_of_end(film, i))}, wrong ? "wrong object" : "picked up"});
    if (deed == Deed::kPut)
      key.push_back({{frame_sign(colour_of_end(film, i))}, wrong ? "wrong receptacle" : "filled"});
  }
  if (has_counts(cell, passages(cells_up_to(film, film.steps())))) key.push_back({{draw_count_sign}, "passages"});
  return key;
}

int cell_within(const Kitchen& kitchen, double side_pt, const Pixels& px) {
  return px(std::min({kMostCellPt, side_pt / kitchen.rows, side_pt / kitchen.columns}));
}

}  // namespace

Canvas draw_kitchen_episode(const KitchenFilm& film, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), between = px(20), cell = cell_within(film.kitchen, kSidePt, px);
  const int wide = film.kitchen.columns * cell, high = film.kitchen.rows * cell, bar = time_bar_width(font, px);
  const std::vector<KeyEntry> entries = key_entries(film, cell);
  int key_width = 0;
  for (const KeyEntry& entry : entries) key_width = std::max(key_width, px(16) + font.width(entry.name, px(kTextPt)));
  const Key key(entries, 1, style.scale, font);  // one below the other
  const int inside = std::max(wide + bar + between + key_width, px(kLeastStripPt));
  const Heading heading(style.title.empty() ? film.name() : style.title, describe(film), inside, style.scale, font);
  const Strip strip("what the agent saw as it took these steps", strip_pictures(film, style.strip), kStripColumns, 1,
                    inside, px, font);

  const int plan_y = margin + heading.height() + px(4), panel = std::max(high, key.height()),
            strip_y = plan_y + panel + px(14);
  const int bottom = strip.height() > 0 ? strip_y + strip.height() : plan_y + panel;
  Canvas canvas(inside + 2 * margin, bottom + margin, font);
  heading.draw(canvas, margin, margin);
  draw_way(canvas, {margin, plan_y, cell, film.kitchen.columns}, film, film.steps(), false);
  draw_time_bar(canvas, margin + wide, plan_y, high, film.steps(), event_marks(film), px);
  key.draw(canvas, margin + wide + bar + between, plan_y);
  strip.draw(canvas, margin, strip_y);
  return canvas;
}

Canvas draw_kitchen_frame(const KitchenFilm& film, int moment, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), between = px(kMarginPt), title = px(12), text = px(kTextPt),
            panels_y = margin + px(17) + px(16);
  const int cell = cell_within(film.kitchen, kFrameSidePt, px), wide = film.kitchen.columns * cell,
            high = film.kitchen.rows * cell;
  const int side = std::max(px(kFrameSidePt), high), width = wide + between + side;
  const auto even = [](int n) { return n + n % 2; };
  Canvas canvas(even(2 * margin + width), even(panels_y + side + margin), font);
  canvas.text(margin, margin, font.fitted(style.title.empty() ? film.name() : style.title, title, width), title, kInk);
  const std::string words = moment == film.steps()
                                ? concat(outcome(film), " after step ", moment)
                                : concat("step ", moment + 1, " of ", film.steps(), ": ", action_words(film, moment));
  canvas.text(margin, margin + px(17), font.fitted(words, text, width), text, kSoftInk);
  draw_way(canvas, {margin, panels_y + (side - high) / 2, cell, film.kitchen.columns}, film, moment, true);
  draw_kitchen_seen(canvas, {margin + wide + between, panels_y, side, side}, film.world.scene(film.pair.env),
                    film.frame(moment));
  return canvas;
}

}  // namespace synpo
