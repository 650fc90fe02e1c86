#include "draw/grid/episode_picture.h"

#include <algorithm>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/colour.h"
#include "draw/episode/film_strip.h"
#include "draw/episode/path.h"
#include "draw/episode/time_bar.h"
#include "draw/grid/agent_view.h"
#include "draw/grid/maze_picture.h"

namespace synpo {
namespace {

constexpr double kCellPt = 20, kFrameCellPt = 13, kMarginPt = 12, kTextPt = 9;
constexpr int kMostColumns = 6;
constexpr Rgb kWrong = {200, 0, 0};

std::string name_of(const Film& film) { return film.maze.name + ", task " + film.task.name(); }

std::vector<int> cells_up_to(const Film& film, int moment) {
  std::vector<int> cells;
  for (int i = 0; i <= moment; ++i) cells.push_back(film.states[i].now.agent);
  return cells;
}

void draw_start(Canvas& canvas, const Box& box) {
  const Point centre = {box.x + box.width / 2.0, box.y + box.height / 2.0};
  canvas.disc(centre, box.width * 0.34, kPaperAgent);
  canvas.disc(centre, box.width * 0.22, kPaper);
}

void draw_picked(Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 9), kPaperAgent); }

void draw_wrong(Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 5), kWrong); }

Sign on_treasure(int treasure, Sign mark) {
  return [treasure, mark](Canvas& canvas, const Box& box) {
    draw_treasure(canvas, box, treasure);
    mark(canvas, box);
  };
}

// Maze, way, start, treasures and what became of them, up to a moment.
void draw_way(Canvas& canvas, const PlanGrid& place, const Film& film, int moment, bool with_agent) {
  const std::vector<int> cells = cells_up_to(film, moment);
  draw_maze(canvas, place.x, place.y, place.cell, film.maze);
  draw_path(canvas, place, cells, film.steps(), kPaperFloor);
  draw_start(canvas, place.box(cells[0]));
  const auto& treasures = film.states[0].now.treasures;
  for (int i = 0; i < kTreasures; ++i) {
    draw_treasure(canvas, place.box(treasures[i]), i);
    if (treasures[i] == cells[0]) draw_start(canvas, place.box(cells[0]));
  }
  for (int i = 0; i < moment; ++i) {
    const int picked = treasure_picked(film, i);
    if (picked >= 0) (film.results[i].wrong ? draw_wrong : draw_picked)(canvas, place.box(treasures[picked]));
  }
  if (with_agent) draw_agent(canvas, place.box(cells.back()));
  draw_counts(canvas, place, cells);
}

std::vector<TimeMark> pick_marks(const Film& film) {
  std::vector<TimeMark> marks;
  for (int i = 0; i < film.steps(); ++i)
    if (const int picked = treasure_picked(film, i); picked >= 0)
      marks.push_back({i + 1, on_treasure(picked, film.results[i].wrong ? draw_wrong : draw_picked)});
  return marks;
}

std::vector<KeyEntry> key_entries(const Film& film, int cell) {
  std::vector<KeyEntry> key = {{{draw_start}, "start"}};
  if (!film.results.back().terminated) key.push_back({{draw_agent}, "end"});
  key.push_back({{treasure_sign(film.task.first)}, "pick first"});
  key.push_back({{treasure_sign(film.task.second)}, "pick second"});
  if (film.states.back().picked > 0) key.push_back({{draw_picked}, "picked"});
  if (film.results.back().wrong) key.push_back({{draw_wrong}, "wrong pick"});
  if (has_counts(cell, cells_up_to(film, film.steps()))) key.push_back({{draw_count_sign}, "moments in this cell"});
  return key;
}

std::vector<StripPicture> strip_pictures(const Film& film, int64_t count) {
  std::vector<StripPicture> pictures;
  if (count == 0) return pictures;
  for (const int i : key_moments(film, int(count))) {
    const int picked = treasure_picked(film, i);
    std::string label = concat(i + 1, ": ", kGridActionNames[film.actions[i]]);
    if (picked >= 0) label += concat(" ", kTreasureLetters[picked]);
    pictures.push_back({step_colour(i + 1, film.steps()), label, [&film, i](Canvas& canvas, const Box& box) {
                          draw_seen(canvas, box.x, box.y, box.width / kGridSide, film.maze, &film.states[i].now,
                                    film.radius);
                        }});
  }
  return pictures;
}

}  // namespace

Canvas draw_episode(const Film& film, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), side = kGridSide * px(kCellPt), inside = side + time_bar_width(font, px),
            window = 2 * film.radius + 1;
  const Heading heading(style.title.empty() ? name_of(film) : style.title, describe(film), inside, style.scale, font);
  const Key key(key_entries(film, px(kCellPt)), inside, style.scale, font);
  const Strip strip(concat("what the agent saw as it took these steps, window ", window, " x ", window),
                    strip_pictures(film, style.strip), kMostColumns, kGridSide, inside, px, font);

  const int maze_y = margin + heading.height() + px(4), key_y = maze_y + side + px(12),
            strip_y = key_y + key.height() + px(14);
  const int bottom = strip.height() > 0 ? strip_y + strip.height() : key_y + key.height();
  Canvas canvas(inside + 2 * margin, bottom + margin, font);
  heading.draw(canvas, margin, margin);
  const PlanGrid place = maze_grid(margin, maze_y, px(kCellPt));
  draw_way(canvas, place, film, film.steps(), !film.results.back().terminated);
  draw_time_bar(canvas, margin + side, maze_y, side, film.steps(), pick_marks(film), px);
  key.draw(canvas, margin, key_y);
  strip.draw(canvas, margin, strip_y);
  return canvas;
}

Canvas draw_episode_frame(const Film& film, int moment, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), cell = px(kFrameCellPt), side = kGridSide * cell, between = px(kMarginPt);
  const int title = px(12), text = px(kTextPt), panels_y = margin + px(17) + px(16);
  const auto even = [](int n) { return n + n % 2; };
  Canvas canvas(even(2 * margin + 2 * side + between), even(panels_y + side + margin), font);
  const int width = 2 * side + between;
  canvas.text(margin, margin, font.fitted(style.title.empty() ? name_of(film) : style.title, title, width), title,
              kInk);
  std::string words;
  if (moment == film.steps()) {
    words = concat(outcome(film), " after step ", moment);
  } else {
    words = concat("step ", moment + 1, " of ", film.steps(), ": ", kGridActionNames[film.actions[moment]]);
    if (const int picked = treasure_picked(film, moment); picked >= 0) words += concat(" ", kTreasureLetters[picked]);
  }
  canvas.text(margin, margin + px(17), font.fitted(words, text, width), text, kSoftInk);
  const PlanGrid place = maze_grid(margin, panels_y, cell);
  draw_way(canvas, place, film, moment, true);
  draw_seen(canvas, margin + side + between, panels_y, cell, film.maze, &film.states[moment].now, film.radius);
  return canvas;
}

}  // namespace synpo
