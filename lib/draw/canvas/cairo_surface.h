// Drawing with cairo: pixels and PDF.
#pragma once
#include <cairo.h>

#include <cstdint>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/surface.h"

namespace synpo {

class CairoSurface : public Surface {
 public:
  CairoSurface(const CairoSurface&) = delete;
  CairoSurface& operator=(const CairoSurface&) = delete;
  ~CairoSurface() override;

  void boxes(const std::vector<Box>& boxes, Rgb colour) override;
  void polygon(const std::vector<Point>& corners, const Paint& paint) override;
  void disc(Point centre, double radius, Rgb colour) override;
  void line(const std::vector<LinePart>& parts, double width, Rgb colour, const Box& clip) override;
  void picture(const Box& box, const std::vector<uint8_t>& rgb) override;
  void text(const TextRun& run, const Font& font) override;

 protected:
  // `outlines`: text is filled shapes, which may stand anywhere, and not glyphs of a font.
  CairoSurface(cairo_surface_t* surface, bool outlines);
  // Throws std::bad_alloc or kInternal where the drawing failed.
  void check() const;
  cairo_surface_t* surface_;
  cairo_t* cairo_;

 private:
  bool outlines_;
};

// White pixels.
class Raster : public CairoSurface {
 public:
  Raster(int width, int height);
  Rgb at(int x, int y) const;
  // 8 bits a channel; at so many pixels per point, which says how large it is on paper. The same bytes for the same
  // pixels.
  std::string png(double scale) const;

 private:
  const uint8_t* pixels_;
  int stride_;
};

// A page of `width` x `height` pixels at so many pixels per point.
class PdfPage : public CairoSurface {
 public:
  // The bytes of the file go to `to`, which outlives this.
  PdfPage(std::string& to, int width, int height, double scale);
  // Ends the page and the file. The same bytes for the same drawing.
  void finish();
};

}  // namespace synpo
