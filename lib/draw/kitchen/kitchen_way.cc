// An episode's way over a kitchen's plan.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/key.h"
#include "draw/canvas/shapes.h"
#include "draw/colour.h"
#include "draw/face/film.h"
#include "draw/face/path.h"
#include "draw/face/plan_grid.h"
#include "draw/face/world_face.h"
#include "draw/kitchen/kitchen_colours.h"
#include "draw/kitchen/kitchen_face.h"
#include "draw/kitchen/kitchen_moment.h"
#include "draw/kitchen/kitchen_picture.h"
#include "draw/paper.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/view/view.h"
#include "world/world.h"

namespace synpo {
namespace {

void draw_turn_sign(Canvas& canvas, const Box& box) {
  draw_arrowhead(canvas, {box.x + box.width / 2.0, box.y + 0.2 * box.height}, {0, -1}, 0.6 * box.height,
                 time_colour(0.5));
}

void draw_line(Canvas& canvas, Point from, Point to, double width, const Dash& dash, Rgb colour) {
  canvas.line({from, to}, width, colour, dash);
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

void ring_object(Canvas& canvas, const Box& box, int object, Rgb colour) {
  canvas.disc(box.centre(), box.width * 0.66, colour);
  draw_object(canvas, box, object);
}

// Around the box, as what is open is dark.
void frame_receptacle(Canvas& canvas, const Box& box, int line, Rgb colour) {
  canvas.frame(box.inset(-line), line, colour);
}

// The place of the box that is nearest to the agent.
Point nearest(const Box& box, Point to) {
  return {std::clamp(to.x, double(box.x), double(box.right())), std::clamp(to.y, double(box.y), double(box.bottom()))};
}

Sign ringed_object(int object, Rgb colour) {
  return [object, colour](Canvas& canvas, const Box& box) {
    const int inset = box.width / 7;
    ring_object(canvas, box.inset(inset), object, colour);
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
    canvas.disc(box.centre(), box.width * 0.5, colour);
    canvas.disc(box.centre(), box.width * 0.34, kPaper);
  };
}

Sign frame_sign(Rgb colour) {
  return [colour](Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 6), colour); };
}

Rgb colour_of_end(const Film& film, int i) { return film.results[size_t(i)].wrong ? kPaperWrong : kPaperAgent; }

}  // namespace

// Where it lay at the start.
Box KitchenFace::object_place(const PlanGrid& place, const Film& film, int object) const {
  const int cell = frame(film, 0).objects[size_t(object)];
  return object_box(place, plan_cell(kitchen(film), cell / kRayStride, cell % kRayStride));
}

Sign KitchenFace::event_sign(const Film& film, int i) const {
  const KitchenEvent done = event(film, i);
  switch (done.deed) {
    case Deed::kNone:
      return nullptr;
    case Deed::kPicked:
      return ringed_object(done.thing, colour_of_end(film, i));
    case Deed::kPut:
      return framed_receptacle(done.thing, colour_of_end(film, i));
    default:
      return receptacle_sign(done.thing);
  }
}

void KitchenFace::draw_ground(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown shown) const {
  const KitchenFrame now = frame(film, moment);
  draw_kitchen(canvas, place, kitchen(film), now.doors, Lettering::kNames);
  if (shown == Shown::kMoment) draw_sight(canvas, place, kitchen(film), now.eye);
}

void KitchenFace::draw_steps(Canvas& canvas, const PlanGrid& place, const Film& film, int moment) const {
  const Rgb floor = paper_floor(kitchen(film).hash)[0];
  draw_path(canvas, place, agent_cells(film, moment), film.steps(), floor);
  for (int i = 0; i < moment; ++i) {
    const KitchenPose from = frame(film, i).eye, to = frame(film, i + 1).eye;
    if (from.heading == to.heading) continue;
    const Point centre = place.centre(plan_cell(kitchen(film), to.row, to.column));
    const Point ahead = {double(kColumnStep[to.heading / 90]), double(kRowStep[to.heading / 90])};
    const double cell = place.cell;
    const auto tip = [&](double share) {
      return Point{centre.x + ahead.x * share * cell, centre.y + ahead.y * share * cell};
    };
    draw_arrowhead(canvas, tip(0.49), ahead, 0.33 * cell, floor);
    draw_arrowhead(canvas, tip(0.46), ahead, 0.26 * cell, step_colour(i + 1, film.steps()));
  }
}

void KitchenFace::draw_things(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, Shown) const {
  const std::vector<int> cells = agent_cells(film, moment);
  for (int i = 0; i < moment; ++i) {
    const KitchenEvent done = event(film, i);
    if (done.deed == Deed::kNone) continue;
    const Box target = done.deed == Deed::kPicked ? object_place(place, film, done.thing)
                                                  : receptacle_box(place, kitchen(film), done.thing);
    if (done.deed == Deed::kPut) frame_receptacle(canvas, target, std::max(2, place.cell / 6), colour_of_end(film, i));
    const Point from = place.centre(cells[size_t(i)]);
    draw_grasp(canvas, from, done.deed == Deed::kPicked ? target.centre() : nearest(target, from), place.cell,
               step_colour(i + 1, film.steps()));
  }
  draw_objects(canvas, place, kitchen(film), frame(film, 0), kitchen_task(film.pair.task).object);
  for (int i = 0; i < moment; ++i)
    if (const KitchenEvent done = event(film, i); done.deed == Deed::kPicked)
      ring_object(canvas, object_place(place, film, done.thing), done.thing, colour_of_end(film, i));
  const KitchenPose eye = frame(film, moment).eye;
  draw_looker(canvas, agent_box(place, kitchen(film), eye), eye.heading);
}

std::vector<int> KitchenFace::counted_cells(const Film& film, int moment) const {
  std::vector<int> cells = agent_cells(film, moment);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::vector<KeyEntry> KitchenFace::way_key(const Film& film, int cell) const {
  const KitchenTask task = kitchen_task(film.pair.task);
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
    const Deed deed = event(film, i).deed;
    const bool wrong = film.results[size_t(i)].wrong;
    if (deed == Deed::kPicked)
      key.push_back({{ring_sign(colour_of_end(film, i))}, wrong ? "wrong object" : "picked up"});
    if (deed == Deed::kPut)
      key.push_back({{frame_sign(colour_of_end(film, i))}, wrong ? "wrong receptacle" : "filled"});
  }
  if (has_counts(cell, counted_cells(film, film.steps()))) key.push_back({{draw_count_sign}, "passages"});
  return key;
}

}  // namespace synpo
