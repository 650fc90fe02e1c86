#include "draw/episode_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "draw/agent_view.h"
#include "draw/colour.h"
#include "draw/heading.h"
#include "draw/path.h"
#include "draw/ticks.h"

namespace synpo {
namespace {

constexpr double kCellPt = 20, kFrameCellPt = 13, kMarginPt = 12, kTextPt = 9, kSmallTextPt = 7.5;
constexpr int kMostColumns = 6;
constexpr Rgb kWrong = {200, 0, 0};

std::string name_of(const Film& film) { return film.maze.name + ", task " + film.task.name(); }

Rgb colour_of_step(const Film& film, int step) { return time_colour(film.steps() > 1 ? double(step - 1) / (film.steps() - 1) : 1); }

std::vector<uint8_t> cells_up_to(const Film& film, int moment) {
  std::vector<uint8_t> cells;
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

std::array<int, kGridCells> moments_in(const std::vector<uint8_t>& cells) {
  std::array<int, kGridCells> moments = {};
  for (const uint8_t cell : cells) ++moments[cell];
  return moments;
}

// Size of the numbers in the cells; 0 where they could not be read.
int count_size(int cell) { return cell / 3 < 8 ? 0 : cell / 3; }

// How many moments the agent was there, in a corner of the cells where the path cannot tell.
void draw_counts(Canvas& canvas, const MazePlace& place, const std::vector<uint8_t>& cells) {
  const auto moments = moments_in(cells);
  const int size = count_size(place.cell);
  if (size == 0) return;
  for (int cell = 0; cell < kGridCells; ++cell) {
    if (moments[cell] <= kPathLanes) continue;
    const Box box = place.box(cell);
    const std::string text = concat(moments[cell], "\u00d7");
    const int width = canvas.font().width(text, size) + 2, height = canvas.font().digit_height(size) + 3;
    canvas.fill({box.right() - width - 1, box.bottom() - height - 1, width, height}, kPaper);
    canvas.text(box.right() - 2, box.bottom() - 3, text, size, kInk, Across::kRight, Upright::kBaseline);
  }
}

// Maze, way, start, treasures and what became of them, up to a moment.
void draw_way(Canvas& canvas, const MazePlace& place, const Film& film, int moment, bool with_agent) {
  const std::vector<uint8_t> cells = cells_up_to(film, moment);
  draw_maze(canvas, place.x, place.y, place.cell, film.maze);
  draw_path(canvas, place, cells, film.steps());
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

// Steps downwards, with the treasures beside the steps that picked them.
void draw_time_bar(Canvas& canvas, const Box& bar, const Film& film, const Pixels& px) {
  const int steps = film.steps(), text = px(kTextPt), sign = px(11);
  for (int y = 0; y < bar.height; ++y) canvas.fill({bar.x, bar.y + y, bar.width, 1}, time_colour(double(y) / std::max(1, bar.height - 1)));
  const auto row = [&](double step) { return bar.y + int(std::lround(bar.height * (step - 1) / std::max(1, steps - 1))); };
  const auto label = [&](int step) {
    canvas.fill({bar.right(), row(step), px(3), px(0.6)}, kSoftInk);
    canvas.text(bar.right() + px(5), row(step), concat(step), text, kInk, Across::kLeft, Upright::kMiddle);
  };
  std::vector<int> labels = {1};
  if (steps > 1) {
    labels.push_back(steps);
    for (const double at : nice_ticks(1, steps, 8).at)
      if (at == std::floor(at) && row(at) - row(1) >= 2 * text && row(steps) - row(at) >= 2 * text) labels.push_back(int(at));
  }
  for (const int step : labels) label(step);
  for (int i = 0; i < steps; ++i)
    if (const int picked = treasure_picked(film, i); picked >= 0) {
      const Box box = {bar.x + (bar.width - sign) / 2, row(i + 1) - sign / 2, sign, sign};
      on_treasure(picked, film.results[i].wrong ? draw_wrong : draw_picked)(canvas, box);
    }
  canvas.text(bar.x - (sign - bar.width) / 2, bar.y - px(14), "step", text, kSoftInk);
}

void draw_count_sign(Canvas& canvas, const Box& box) {
  canvas.text(box.right(), box.y + box.height / 2, "9\u00d7", box.height * 3 / 4, kInk, Across::kRight, Upright::kMiddle);
}

std::vector<KeyEntry> key_entries(const Film& film, int cell) {
  std::vector<KeyEntry> key = {{{draw_start}, "start"}};
  if (!film.results.back().terminated) key.push_back({{draw_agent}, "end"});
  key.push_back({{treasure_sign(film.task.first)}, "pick first"});
  key.push_back({{treasure_sign(film.task.second)}, "pick second"});
  if (film.states.back().picked > 0) key.push_back({{draw_picked}, "picked"});
  if (film.results.back().wrong) key.push_back({{draw_wrong}, "wrong pick"});
  const auto moments = moments_in(cells_up_to(film, film.steps()));
  if (count_size(cell) > 0 && *std::max_element(moments.begin(), moments.end()) > kPathLanes)
    key.push_back({{draw_count_sign}, "moments in this cell"});
  return key;
}

// The pictures of the moments chosen, each in a frame of its step's colour.
class Strip {
 public:
  Strip(const Film& film, int64_t count, int width, const Pixels& px)
      : film_(film), moments_(count > 0 ? key_moments(film, int(count)) : std::vector<int>()), px_(px), gap_(px(8)), line_(px(1.5)),
        cell_(std::max(1, ((width + gap_) / kMostColumns - gap_ - 2 * line_) / kGridSide)), columns_(std::min(kMostColumns, (width + gap_) / (side() + gap_))),
        columns_gap_((width - columns_ * side()) / (columns_ - 1)) {}

  int height() const { return moments_.empty() ? 0 : heading() + rows() * row_height() - px_(6); }

  void draw(Canvas& canvas, int x, int y) const {
    if (moments_.empty()) return;
    const std::string window = concat(2 * film_.radius + 1, " x ", 2 * film_.radius + 1);
    canvas.text(x, y, concat("what the agent saw as it took these steps, window ", window), px_(kTextPt), kSoftInk);
    for (size_t i = 0; i < moments_.size(); ++i) {
      const int left = x + int(i) % columns_ * (side() + columns_gap_), top = y + heading() + int(i) / columns_ * row_height();
      const GridFrame& seen = film_.states[moments_[i]].now;
      canvas.fill({left, top, side(), side()}, colour_of_step(film_, moments_[i] + 1));
      draw_seen(canvas, left + line_, top + line_, cell_, film_.maze, &seen, film_.radius);
      const int picked = treasure_picked(film_, moments_[i]);
      std::string label = concat(moments_[i] + 1, ": ", kGridActionNames[film_.actions[moments_[i]]]);
      if (picked >= 0) label += concat(" ", kTreasureLetters[picked]);
      canvas.text(left + side() / 2, top + side() + px_(4), label, px_(kSmallTextPt), kInk, Across::kCentre);
    }
  }

 private:
  int side() const { return cell_ * kGridSide + 2 * line_; }
  int rows() const { return (int(moments_.size()) + columns_ - 1) / columns_; }
  int row_height() const { return side() + px_(4) + px_(kSmallTextPt) + px_(6); }
  int heading() const { return px_(kTextPt) + px_(7); }
  const Film& film_;
  std::vector<int> moments_;
  Pixels px_;
  int gap_, line_, cell_, columns_, columns_gap_;
};

}  // namespace

Canvas draw_episode(const Film& film, const EpisodeStyle& style, const Font& font) {
  const Pixels px{style.scale};
  const int margin = px(kMarginPt), side = kGridSide * px(kCellPt), bar_gap = px(14), bar_width = px(9);
  const int inside = side + bar_gap + bar_width + px(5) + font.width("300", px(kTextPt));
  const Heading heading(style.title.empty() ? name_of(film) : style.title, describe(film), inside, style.scale, font);
  const Key key(key_entries(film, px(kCellPt)), inside, style.scale, font);
  const Strip strip(film, style.strip, inside, px);

  const int maze_y = margin + heading.height() + px(4), key_y = maze_y + side + px(12), strip_y = key_y + key.height() + px(14);
  const int bottom = strip.height() > 0 ? strip_y + strip.height() : key_y + key.height();
  Canvas canvas(inside + 2 * margin, bottom + margin, font);
  heading.draw(canvas, margin, margin);
  const MazePlace place = {margin, maze_y, px(kCellPt)};
  draw_way(canvas, place, film, film.steps(), !film.results.back().terminated);
  draw_time_bar(canvas, {margin + side + bar_gap, maze_y + px(16), bar_width, side - px(22)}, film, px);
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
  canvas.text(margin, margin, font.fitted(style.title.empty() ? name_of(film) : style.title, title, width), title, kInk);
  std::string words;
  if (moment == film.steps()) {
    words = concat(outcome(film), " after step ", moment);
  } else {
    words = concat("step ", moment + 1, " of ", film.steps(), ": ", kGridActionNames[film.actions[moment]]);
    if (const int picked = treasure_picked(film, moment); picked >= 0) words += concat(" ", kTreasureLetters[picked]);
  }
  canvas.text(margin, margin + px(17), font.fitted(words, text, width), text, kSoftInk);
  const MazePlace place = {margin, panels_y, cell};
  draw_way(canvas, place, film, moment, true);
  draw_seen(canvas, margin + side + between, panels_y, cell, film.maze, &film.states[moment].now, film.radius);
  return canvas;
}

}  // namespace synpo
