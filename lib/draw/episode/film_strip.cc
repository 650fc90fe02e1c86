#include "draw/episode/film_strip.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "draw/colour.h"

namespace synpo {
namespace {

constexpr double kTextPt = 9, kLabelPt = 7.5, kLinePt = 10;

}  // namespace

FilmStrip::FilmStrip(std::string heading, std::vector<StripPicture> pictures, int columns, int unit, int width,
                     const Pixels& px, const Font& font)
    : heading_(std::move(heading)), pictures_(std::move(pictures)), px_(px), gap_(px(8)), line_(px(1.5)),
      side_(std::max(1, ((width + gap_) / columns - gap_ - 2 * line_) / unit) * unit + 2 * line_),
      columns_(std::min(columns, (width + gap_) / (side_ + gap_))),
      columns_gap_((width - columns_ * side_) / (columns_ - 1)) {
  for (const StripPicture& picture : pictures_) {
    labels_.push_back(font.wrapped(picture.label, px(kLabelPt), side_ + columns_gap_ - px(6)));
    lines_ = std::max(lines_, int(labels_.back().size()));
  }
}

int FilmStrip::row_height() const { return side_ + px_(4) + px_(kLabelPt) + (lines_ - 1) * px_(kLinePt) + px_(6); }
int FilmStrip::heading_height() const { return px_(kTextPt) + px_(7); }
int FilmStrip::height() const { return pictures_.empty() ? 0 : heading_height() + rows() * row_height() - px_(6); }

void FilmStrip::draw(Canvas& canvas, int x, int y) const {
  if (pictures_.empty()) return;
  canvas.text(x, y, heading_, px_(kTextPt), kSoftInk);
  for (size_t i = 0; i < pictures_.size(); ++i) {
    const int left = x + int(i) % columns_ * (side_ + columns_gap_),
              top = y + heading_height() + int(i) / columns_ * row_height();
    canvas.fill({left, top, side_, side_}, pictures_[i].frame);
    pictures_[i].draw(canvas, {left + line_, top + line_, side_ - 2 * line_, side_ - 2 * line_});
    int below = top + side_ + px_(4);
    for (const std::string& line : labels_[i]) {
      canvas.text(left + side_ / 2, below, line, px_(kLabelPt), kInk, Across::kCentre);
      below += px_(kLinePt);
    }
  }
}

}  // namespace synpo
