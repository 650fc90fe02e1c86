// A picture to draw on: filled shapes and text in pixels, anti-aliased; PNG bytes out.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/font.h"

namespace synpo {

struct Point {
  double x, y;
};

struct Box {
  int x, y, width, height;
  int right() const { return x + width; }
  int bottom() const { return y + height; }
  Point centre() const { return {x + width / 2.0, y + height / 2.0}; }
  // So many pixels smaller at every side.
  Box inset(int by) const { return {x + by, y + by, width - 2 * by, height - 2 * by}; }
};

// Points to pixels: at least one.
struct Pixels {
  double scale;
  int operator()(double pt) const { return std::max(1, int(std::lround(pt * scale))); }
};

// How much of each pixel of the box something covers, 0 to 255.
struct Mask {
  Box box;
  std::vector<uint8_t> coverage;  // [height, width]
};

// Where the point given lies in the text: across, and up and down. Middle is the middle of a digit's height.
enum class Across { kLeft, kCentre, kRight };
enum class Upright { kTop, kMiddle, kBaseline };

constexpr Cause kPictureTooLarge{"the picture is too large"};

class Canvas {
 public:
  // White. Throws kUsage (kPictureTooLarge) for a picture of more than 400 million pixels or 30,000 a side. `font`
  // outlives the canvas.
  Canvas(int width, int height, const Font& font);
  ~Canvas();
  Canvas(Canvas&&) noexcept;

  int width() const;
  int height() const;
  const Font& font() const { return font_; }
  Rgb at(int x, int y) const;

  void fill(const Box& box, Rgb colour);
  // A border of `line` pixels just inside the box.
  void frame(const Box& box, int line, Rgb colour);
  void polygon(const std::vector<Point>& corners, Rgb colour);
  void disc(Point centre, double radius, Rgb colour);

  // rgb [height, width, 3] of the box, pixel for pixel; it lies within the picture.
  void picture(const Box& box, const uint8_t* rgb);

  // Colours what the mask covers; `opacity` from 0 to 1. The box may reach beyond the picture.
  void paint(const Mask& mask, Rgb colour, double opacity = 1);

  void text(int x, int y, const std::string& text, int size, Rgb colour, Across across = Across::kLeft,
            Upright upright = Upright::kTop);
  // Reading upwards: the text's end is at the top. x is its middle across the line, y where the text begins (kLeft:
  // bottom end), has its centre, or ends.
  void text_up(int x, int y, const std::string& text, int size, Rgb colour, Across along = Across::kLeft);

  // Pixels of text that fell outside the picture: 0 in a picture that is laid out well.
  int64_t clipped() const { return clipped_; }

  // The same bytes for the same pixels.
  std::string png() const;

 private:
  void blend(int x, int y, uint8_t coverage, Rgb colour);
  struct Pixels;
  std::unique_ptr<Pixels> pixels_;
  const Font& font_;
  int64_t clipped_ = 0;
};

}  // namespace synpo
