// Drawing as the elements of an SVG file.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/surface.h"

namespace synpo {

class SvgSurface : public Surface {
 public:
  // `width` x `height` pixels at so many pixels per point. Text names the font's family, which is not in the file.
  SvgSurface(int width, int height, double scale, const Font& font);

  void boxes(const std::vector<Box>& boxes, Rgb colour) override;
  void polygon(const std::vector<Point>& corners, const Paint& paint) override;
  void disc(Point centre, double radius, Rgb colour) override;
  void line(const std::vector<LinePart>& parts, double width, Rgb colour, const Box& clip) override;
  void picture(const Box& box, const std::vector<uint8_t>& rgb) override;
  void text(const TextRun& run, const Font& font) override;

  // The whole file.
  std::string svg() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

}  // namespace synpo
