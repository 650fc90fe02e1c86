#include "draw/heading.h"

#include <algorithm>
#include <cmath>

#include "draw/colour.h"

namespace synpo {

Heading lay_out_heading(const std::string& title, const std::string& caption, int width, double scale, const Font& font,
                        double title_pt) {
  constexpr double kCaptionPt = 8.5, kLeading = 1.45;
  const auto px = [&](double pt) { return std::max(1, int(std::lround(pt * scale))); };
  Heading out{{}, {}, px(title_pt), px(title_pt * kLeading), px(kCaptionPt), px(kCaptionPt * kLeading)};
  out.title = font.wrapped(title, out.title_size, width);
  out.caption = font.wrapped(caption, out.caption_size, width);
  return out;
}

void draw_heading(Canvas& canvas, const Heading& heading, int x, int y) {
  for (const std::string& line : heading.title) {
    canvas.text(x, y, line, heading.title_size, kInk);
    y += heading.title_line;
  }
  for (const std::string& line : heading.caption) {
    canvas.text(x, y, line, heading.caption_size, kSoftInk);
    y += heading.caption_line;
  }
}

}  // namespace synpo
