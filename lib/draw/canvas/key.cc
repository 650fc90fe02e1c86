#include "draw/canvas/key.h"

#include <cstddef>
#include <utility>

#include "draw/colour.h"

namespace synpo {

Sign colour_sign(Rgb colour) {
  return [colour](Canvas& canvas, const Box& box) {
    canvas.fill(box, colour);
    canvas.frame(box, 1, kHairline);
  };
}

Key::Key(std::vector<KeyEntry> entries, int width, double scale, const Font& font) : entries_(std::move(entries)) {
  const Pixels px{scale};
  sign_ = px(11);
  space_ = px(3);
  before_name_ = px(2);
  text_ = px(9);
  Place next = {0, 0};
  for (const KeyEntry& entry : entries_) {
    const int entry_width = int(entry.signs.size()) * (sign_ + space_) + before_name_ + font.width(entry.name, text_);
    if (next.x > 0 && next.x + entry_width > width) next = {0, next.y + sign_ + px(7)};
    places_.push_back(next);
    next.x += entry_width + px(18);
  }
  height_ = next.y + sign_;
}

void Key::draw(Canvas& canvas, int x, int y) const {
  for (size_t i = 0; i < entries_.size(); ++i) {
    int left = x + places_[i].x;
    const int top = y + places_[i].y;
    for (const Sign& sign : entries_[i].signs) {
      sign(canvas, {left, top, sign_, sign_});
      left += sign_ + space_;
    }
    canvas.text(left + before_name_, top + sign_ / 2, entries_[i].name, text_, kInk, Across::kLeft, Upright::kMiddle);
  }
}

}  // namespace synpo
