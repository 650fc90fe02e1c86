#include "draw/canvas/heading.h"

#include "draw/colour.h"

namespace synpo {

Heading::Heading(const std::string& title, const std::string& caption, int width, double scale, const Font& font,
                 double title_pt) {
  constexpr double kCaptionPt = 8.5, kLeading = 1.45, kSpacePt = 4;
  const Pixels px{scale};
  title_size_ = px(title_pt);
  title_line_ = px(title_pt * kLeading);
  caption_size_ = px(kCaptionPt);
  caption_line_ = px(kCaptionPt * kLeading);
  space_ = px(kSpacePt);
  title_ = font.wrapped(title, title_size_, width);
  caption_ = font.wrapped(caption, caption_size_, width);
}

int Heading::height() const {
  const int text = int(title_.size()) * title_line_ + int(caption_.size()) * caption_line_;
  return text > 0 ? text + space_ : 0;
}

void Heading::draw(Canvas& canvas, int x, int y) const {
  for (const std::string& line : title_) {
    canvas.text(x, y, line, title_size_, kInk);
    y += title_line_;
  }
  for (const std::string& line : caption_) {
    canvas.text(x, y, line, caption_size_, kSoftInk);
    y += caption_line_;
  }
}

}  // namespace synpo
