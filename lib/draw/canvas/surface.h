// What a canvas's shapes are drawn on: pixels, a page of a PDF, the elements of an SVG.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/font.h"
#include "draw/canvas/shapes.h"

namespace synpo {

struct Paint {
  Rgb colour;
  double opacity = 1;
};

// A line of text whose pen begins at a point of the baseline. `upwards`: reading from below.
struct TextRun {
  std::string text;
  Point pen;
  int size;  // height of the em square
  Rgb colour;
  bool upwards;
  enum class Anchor { kStart, kMiddle, kEnd } anchor;  // what stays in place where another font is used
};

// Lengths and points here are in pixels of the canvas, and far from all limits.
class Surface {
 public:
  virtual ~Surface() = default;
  // Together: where they touch there is no seam.
  virtual void boxes(const std::vector<Box>& boxes, Rgb colour) = 0;
  virtual void polygon(const std::vector<Point>& corners, const Paint& paint) = 0;
  virtual void disc(Point centre, double radius, Rgb colour) = 0;
  // With round ends and joins. Only what lies in `clip` is seen.
  virtual void line(const std::vector<LinePart>& parts, double width, Rgb colour, const Box& clip) = 0;
  // rgb [height, width, 3] of the box, pixel for pixel.
  virtual void picture(const Box& box, const std::vector<uint8_t>& rgb) = 0;
  virtual void text(const TextRun& run, const Font& font) = 0;
};

}  // namespace synpo
