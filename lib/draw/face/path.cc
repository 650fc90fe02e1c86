#include "draw/face/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"
#include "draw/canvas/font.h"
#include "draw/colour.h"
#include "draw/paper.h"

namespace synpo {
namespace {

constexpr double kLaneShare = 0.15, kLineShare = 0.09, kCasingShare = 0.15;  // of a cell
constexpr int kArrowEvery = 3;

// A step that moves: its direction, and how far its lane lies beside the middle, to the right of rising rows and
// columns.
struct Move {
  int step;
  Point direction, aside;
};

std::vector<Move> moves_of(const PlanGrid& place, const std::vector<int>& cells) {
  std::map<std::pair<int, int>, int> passed;
  std::vector<Move> moves;
  for (size_t i = 1; i < cells.size(); ++i) {
    const int from = cells[i - 1], to = cells[i];
    if (from == to) continue;
    const int lane = passed[std::minmax(from, to)]++ % kPathLanes;
    const double offset = (lane % 2 ? 1 : -1) * ((lane + 1) / 2) * kLaneShare * place.cell;
    const double dx = to % place.columns - from % place.columns, dy = to / place.columns - from / place.columns;
    moves.push_back({int(i), {dx, dy}, {std::abs(dy) * offset, std::abs(dx) * offset}});
  }
  return moves;
}

void draw_piece(Canvas& canvas, Point a, Point b, double width, Rgb colour) { canvas.line({a, b}, width, colour); }

// Size of the numbers in the cells; 0 where they could not be read.
int count_size(int cell) { return cell / 3 < 8 ? 0 : cell / 3; }

std::map<int, int> counts_of(const std::vector<int>& cells) {
  std::map<int, int> counts;
  for (const int cell : cells) ++counts[cell];
  return counts;
}

}  // namespace

void draw_arrowhead(Canvas& canvas, Point tip, Point direction, double size, Rgb colour) {
  const Point back = {tip.x - direction.x * size, tip.y - direction.y * size};
  const Point across = {-direction.y * size * 0.6, direction.x * size * 0.6};
  canvas.polygon({tip, {back.x + across.x, back.y + across.y}, {back.x - across.x, back.y - across.y}}, colour);
}

std::vector<PathCorner> path_corners(const PlanGrid& place, const std::vector<int>& cells) {
  const std::vector<Move> moves = moves_of(place, cells);
  std::vector<PathCorner> corners = {{place.centre(cells[0]), 0}};
  const auto add = [&](Point middle, Point aside, Point along, double share, int step) {
    corners.push_back(
        {{middle.x + aside.x + along.x * share * place.cell, middle.y + aside.y + along.y * share * place.cell}, step});
  };
  for (size_t i = 0; i < moves.size(); ++i) {
    const Move& in = moves[i];
    const Point middle = place.centre(cells[in.step]);
    if (i + 1 == moves.size()) {
      add(middle, in.aside, in.direction, 0, in.step);
      continue;
    }
    const Move& out = moves[i + 1];
    const bool turns = in.direction.x * out.direction.x + in.direction.y * out.direction.y == 0;
    const bool reverses = in.direction.x == -out.direction.x && in.direction.y == -out.direction.y;
    if (turns) {
      add(middle, {in.aside.x + out.aside.x, in.aside.y + out.aside.y}, in.direction, 0, in.step);
    } else if (reverses || in.aside.x != out.aside.x || in.aside.y != out.aside.y) {
      // Back, or into another lane.
      add(middle, in.aside, in.direction, reverses ? 0.1 : -0.2, in.step);
      add(middle, out.aside, in.direction, reverses ? 0.1 : 0.2, in.step);
    } else {
      add(middle, in.aside, in.direction, 0, in.step);
    }
  }
  return corners;
}

void draw_path(Canvas& canvas, const PlanGrid& place, const std::vector<int>& cells, int steps, Rgb ground) {
  const std::vector<PathCorner> corners = path_corners(place, cells);
  const double line = std::max(1.5, kLineShare * place.cell), casing = std::max(line + 1, kCasingShare * place.cell);
  const auto colour = [&](size_t i) { return step_colour(corners[i].step, steps); };
  // A piece's casing comes just before it, so that a later way is seen to cross an earlier one; its beginning is drawn
  // over by the piece before it once more, lest the casing cut that one's end.
  for (size_t i = 1; i < corners.size(); ++i) {
    draw_piece(canvas, corners[i - 1].at, corners[i].at, casing, ground);
    if (i > 1) draw_piece(canvas, corners[i - 2].at, corners[i - 1].at, line, colour(i - 1));
    draw_piece(canvas, corners[i - 1].at, corners[i].at, line, colour(i));
  }
  for (size_t i = 1; i < corners.size(); ++i) {
    if (corners[i].step % kArrowEvery != 1 || corners[i].step == corners[i - 1].step) continue;
    const Point a = corners[i - 1].at, b = corners[i].at;
    const double length = std::hypot(b.x - a.x, b.y - a.y), size = 0.3 * place.cell;
    if (length < size) continue;
    const Point direction = {(b.x - a.x) / length, (b.y - a.y) / length};
    const Point tip = {(a.x + b.x + direction.x * size) / 2, (a.y + b.y + direction.y * size) / 2};
    draw_arrowhead(canvas, tip, direction, size, colour(i));
  }
}

bool has_counts(int cell, const std::vector<int>& cells) {
  const auto counts = counts_of(cells);
  return count_size(cell) > 0 &&
         std::any_of(counts.begin(), counts.end(), [](const auto& count) { return count.second > kPathLanes; });
}

void draw_counts(Canvas& canvas, const PlanGrid& place, const std::vector<int>& cells) {
  const int size = count_size(place.cell);
  if (size == 0) return;
  for (const auto& [cell, count] : counts_of(cells)) {
    if (count <= kPathLanes) continue;
    const Box box = place.box(cell);
    const std::string text = concat(count, "\u00d7");
    const int width = canvas.font().width(text, size) + 2, height = canvas.font().digit_height(size) + 3;
    canvas.fill({box.right() - width - 1, box.bottom() - height - 1, width, height}, kPaper);
    canvas.text(box.right() - 2, box.bottom() - 3, text, size, kInk, Across::kRight, Upright::kBaseline);
  }
}

void draw_count_sign(Canvas& canvas, const Box& box) {
  canvas.text(box.right(), box.y + box.height / 2, "n\u00d7", box.height * 3 / 4, kInk, Across::kRight,
              Upright::kMiddle);
}

void draw_start(Canvas& canvas, const Box& box) {
  const Point centre = box.centre();
  canvas.disc(centre, box.width * 0.34, kPaperAgent);
  canvas.disc(centre, box.width * 0.22, kPaper);
}

}  // namespace synpo
