// Title and caption: what stands at the top left of every picture, and of a panel.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas.h"

namespace synpo {

struct Heading {
  std::vector<std::string> title, caption;                   // lines
  int title_size, title_line, caption_size, caption_line;    // heights of text, and from line to line, in pixels
  int height() const { return int(title.size()) * title_line + int(caption.size()) * caption_line; }
};

constexpr double kTitlePt = 12, kPanelTitlePt = 10;

// Broken into lines of at most `width` pixels; either text may be empty.
Heading lay_out_heading(const std::string& title, const std::string& caption, int width, double scale, const Font& font,
                        double title_pt = kTitlePt);
void draw_heading(Canvas& canvas, const Heading& heading, int x, int y);

}  // namespace synpo
