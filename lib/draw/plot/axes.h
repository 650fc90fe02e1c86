// The frame of a plot: axes with ticks, labels and titles, and a light grid.
#pragma once
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/ticks.h"

namespace synpo {

// A plot's frame and what it shows. Titles and labels stand left of the box and beneath it.
class Axes {
 public:
  // `scale` is in pixels per point.
  Axes(const Axis& x, const Axis& y, double scale, const Font& font) : x_(x), y_(y), scale_(scale), font_(font) {}

  // Pixels that labels and titles need around a box of this size.
  struct Margins {
    int left, right, top, bottom;
  };
  Margins margins(int width, int height) const;

  // Grid, ticks, labels and titles. To be called before the curves are drawn, frame() after them.
  void draw(Canvas& canvas, const Box& box) const;
  void frame(Canvas& canvas, const Box& box) const;

  // Where a value lies; outside the box if it is out of the axes' range.
  Point place(const Box& box, double x, double y) const;
  int pixels(double pt) const;

 private:
  // As many ticks as leave room between their labels.
  Ticks x_ticks(int width) const;
  Ticks y_ticks(int height) const;
  int y_label_width(int height) const;
  Axis x_, y_;
  double scale_;
  const Font& font_;
};

}  // namespace synpo
