// A picture to draw on: filled shapes, lines and text in pixels, anti-aliased; PNG, PDF or SVG out.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/canvas/font.h"
#include "draw/canvas/shapes.h"

namespace synpo {

// Where the point given lies in the text: across, and up and down. Middle is the middle of a digit's height.
enum class Across { kLeft, kCentre, kRight };
enum class Upright { kTop, kMiddle, kBaseline };

constexpr Cause kPictureTooLarge{"the picture is too large"};

class Raster;
class Surface;

class Canvas {
 public:
  // White. `scale`, pixels per point, says how large the picture is on paper. Throws kUsage (kPictureTooLarge) for a
  // picture of more than 400 million pixels or 30,000 a side. `font` outlives the canvas.
  Canvas(int width, int height, const Font& font, double scale = 1);
  ~Canvas();
  Canvas(Canvas&&) noexcept;

  int width() const { return width_; }
  int height() const { return height_; }
  const Font& font() const { return font_; }

  void fill(const Box& box, Rgb colour);
  // Together: where they touch there is no seam, however the picture is scaled.
  void fill(const std::vector<Box>& boxes, Rgb colour);
  // A grid of squares, `columns` a row, with sides of so many pixels: a colour each.
  void squares(int x, int y, int side, int columns, const std::vector<Rgb>& colours);
  // From top to bottom, shares of the way from 0 to 1.
  void shades(const Box& box, const std::function<Rgb(double share)>& colour);
  // A border of `line` pixels just inside the box.
  void frame(const Box& box, int line, Rgb colour);
  // What lies in `clip`, where one is given.
  void polygon(const std::vector<Point>& corners, Rgb colour, double opacity = 1);
  void polygon(const std::vector<Point>& corners, Rgb colour, double opacity, const Box& clip);
  void disc(Point centre, double radius, Rgb colour);

  // The line through the points, `width` pixels wide, with round joins and ends; a single point is a disc twice as
  // wide. What lies outside `clip`, or the picture, is left out.
  void line(const std::vector<Point>& points, double width, Rgb colour, const Dash& dash = {});
  void line(const std::vector<Point>& points, double width, Rgb colour, const Dash& dash, const Box& clip);

  // rgb [height, width, 3] of the box, pixel for pixel; it lies within the picture.
  void picture(const Box& box, std::vector<uint8_t> rgb);

  void text(int x, int y, const std::string& text, int size, Rgb colour, Across across = Across::kLeft,
            Upright upright = Upright::kTop);
  // Reading upwards: the text's end is at the top. x is its middle across the line, y where the text begins (kLeft:
  // bottom end), has its centre, or ends.
  void text_up(int x, int y, const std::string& text, int size, Rgb colour, Across along = Across::kLeft);

  // Square pixels of text's ink that fell outside the picture: 0 in a picture that is laid out well.
  double clipped() const { return clipped_; }

  Rgb at(int x, int y) const;

  // The same bytes for the same drawing.
  std::string png() const;
  // One page, with the letters that it shows embedded.
  std::string pdf() const;
  // Names the font, and does not hold it.
  std::string svg() const;

 private:
  Box whole() const { return {0, 0, width_, height_}; }
  void draw(std::function<void(Surface&)> shape);
  void write(const std::string& text, Point pen, int size, Rgb colour, bool upwards, Across across);
  const Raster& raster() const;
  int width_, height_;
  double scale_;
  const Font& font_;
  std::vector<std::function<void(Surface&)>> shapes_;
  mutable std::unique_ptr<Raster> raster_;
  mutable size_t rastered_ = 0;  // of the shapes
  double clipped_ = 0;
};

}  // namespace synpo
