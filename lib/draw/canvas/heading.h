// Title and caption: what stands at the top left of every picture, and of a panel.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"

namespace synpo {

constexpr double kTitlePt = 12, kPanelTitlePt = 10;

class Heading {
 public:
  Heading() = default;  // no text
  // Each is broken into lines of at most `width` pixels; either may be empty. `scale` is in pixels per point.
  Heading(const std::string& title, const std::string& caption, int width, double scale, const Font& font,
          double title_pt = kTitlePt);
  // With the space beneath; 0 for no text.
  int height() const;
  void draw(Canvas& canvas, int x, int y) const;
  const std::vector<std::string>& caption() const { return caption_; }

 private:
  std::vector<std::string> title_, caption_;
  int title_size_ = 0, title_line_ = 0, caption_size_ = 0, caption_line_ = 0, space_ = 0;
};

}  // namespace synpo
