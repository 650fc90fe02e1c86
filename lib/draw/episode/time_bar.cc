#include "draw/episode/time_bar.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.h"
#include "draw/canvas/ticks.h"
#include "draw/colour.h"

namespace synpo {
namespace {

constexpr double kTextPt = 9, kGapPt = 14, kBarPt = 9, kSignPt = 11;

// Middles of the marks: where their steps are, moved up where the next ones' signs would cover them and there is room.
std::vector<int> mark_rows(const std::vector<TimeMark>& marks, const Box& bar, int sign, const auto& row) {
  std::vector<int> rows;
  for (const TimeMark& mark : marks) rows.push_back(row(mark.step));
  if (int(rows.size()) * sign > bar.height) return rows;
  for (size_t i = rows.size(); i-- > 1;) rows[i - 1] = std::min(rows[i - 1], rows[i] - sign);
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = std::max(rows[i], i == 0 ? bar.y : rows[i - 1] + sign);
  return rows;
}

}  // namespace

int time_bar_width(const Font& font, const Pixels& px) {
  return px(kGapPt) + px(kBarPt) + px(5) + font.width("300", px(kTextPt));
}

void draw_time_bar(Canvas& canvas, int x, int y, int height, int steps, const std::vector<TimeMark>& marks,
                   const Pixels& px) {
  const Box bar = {x + px(kGapPt), y + px(16), px(kBarPt), height - px(22)};
  const int text = px(kTextPt), sign = px(kSignPt);
  canvas.shades(bar, time_colour);
  const auto row = [&](double step) {
    return bar.y + int(std::lround(bar.height * (step - 1) / std::max(1, steps - 1)));
  };
  const auto label = [&](int step) {
    canvas.fill({bar.right(), row(step), px(3), px(0.6)}, kSoftInk);
    canvas.text(bar.right() + px(5), row(step), concat(step), text, kInk, Across::kLeft, Upright::kMiddle);
  };
  std::vector<int> labels = {1};
  if (steps > 1) {
    labels.push_back(steps);
    for (const double at : nice_ticks(1, steps, 8).at)
      if (at == std::floor(at) && row(at) - row(1) >= 2 * text && row(steps) - row(at) >= 2 * text)
        labels.push_back(int(at));
  }
  for (const int step : labels) label(step);
  const std::vector<int> rows = mark_rows(marks, bar, sign, row);
  for (size_t i = 0; i < marks.size(); ++i)
    marks[i].sign(canvas, {bar.x + (bar.width - sign) / 2, rows[i] - sign / 2, sign, sign});
  canvas.text(bar.x - (sign - bar.width) / 2, bar.y - px(14), "step", text, kSoftInk);
}

}  // namespace synpo
