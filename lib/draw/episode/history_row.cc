#include "draw/episode/history_row.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "draw/colour.h"
#include "world/observation.h"

namespace synpo {
namespace {

constexpr double kTextPt = 9;

}  // namespace

HistoryRow::HistoryRow(int width, int unit, const Pixels& px)
    : px_(px), side_(std::max(1, (width - (kHistory - 1) * px(8)) / kHistory / unit) * unit),
      gap_((width - kHistory * side_) / (kHistory - 1)) {}

int HistoryRow::height() const { return px_(kTextPt) + px_(8) + side_ + px_(6) + px_(kTextPt); }

void HistoryRow::draw(Canvas& canvas, int x, int y, const std::string& heading, int count,
                      const std::function<void(const Box& box, int i, bool missing)>& draw) const {
  const int text = px_(kTextPt), top = y + text + px_(8);
  canvas.text(x, y, heading, text, kSoftInk);
  for (int i = 0; i < kHistory; ++i, x += side_ + gap_) {
    const bool missing = i < kHistory - count;
    const int ago = kHistory - 1 - i;
    draw({x, top, side_, side_}, i, missing);
    const std::string when = ago == 0 ? "now" : counted(ago, "step") + " ago";
    canvas.text(x + side_ / 2, top + side_ + px_(6), missing ? "before the start: zero" : when, text, kInk,
                Across::kCentre);
  }
}

}  // namespace synpo
