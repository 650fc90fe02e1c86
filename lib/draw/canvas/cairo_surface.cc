#include "draw/canvas/cairo_surface.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <numbers>

#include "base/error.h"
#include "draw/canvas/png.h"

namespace synpo {
namespace {

void check_status(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) fail(Exit::kInternal, "cairo cannot draw: ", cairo_status_to_string(status));
}

cairo_status_t append(void* to, const unsigned char* bytes, unsigned count) {
  static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void set_paint(cairo_t* cairo, Rgb colour, double opacity = 1) {
  cairo_set_source_rgba(cairo, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0, opacity);
}

void add_points(cairo_t* cairo, const std::vector<Point>& points) {
  for (size_t i = 0; i < points.size(); ++i) (i == 0 ? cairo_move_to : cairo_line_to)(cairo, points[i].x, points[i].y);
}

// cairo keeps fonts for a while after their last use, and with them what they are made of.
cairo_font_face_t* font_face(const Font& font) {
  using Hold = std::shared_ptr<FT_FaceRec_>;
  static const cairo_user_data_key_t key{};
  auto hold = std::make_unique<Hold>(font.face());
  cairo_font_face_t* const face = cairo_ft_font_face_create_for_ft_face(hold->get(), 0);
  if (!cairo_font_face_get_user_data(face, &key) &&
      cairo_font_face_set_user_data(face, &key, hold.get(), [](void* held) { delete static_cast<Hold*>(held); }) ==
          CAIRO_STATUS_SUCCESS)
    static_cast<void>(hold.release());  // the font face has it
  return face;
}

void set_font(cairo_t* cairo, const Font& font, int size) {
  cairo_font_face_t* const face = font_face(font);
  cairo_set_font_face(cairo, face);
  cairo_font_face_destroy(face);
  cairo_set_font_size(cairo, size);
  // Letters have the places and shapes that the layout counts on.
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
}

// How many bytes and glyphs belong together, in the order of the text.
std::vector<cairo_text_cluster_t> clusters_of(const TextShape& shape, const std::string& text) {
  struct Cluster {
    uint32_t begin;
    int glyphs;
  };
  std::vector<Cluster> found;
  for (const TextShape::Glyph& glyph : shape.glyphs)
    if (!found.empty() && found.back().begin == glyph.begin)
      ++found.back().glyphs;
    else
      found.push_back({glyph.begin, 1});
  if (shape.leftwards) std::reverse(found.begin(), found.end());
  std::vector<cairo_text_cluster_t> clusters;
  for (size_t i = 0; i < found.size(); ++i) {
    const size_t end = i + 1 < found.size() ? found[i + 1].begin : text.size();
    clusters.push_back({int(end - found[i].begin), found[i].glyphs});
  }
  return clusters;
}

}  // namespace

CairoSurface::CairoSurface(cairo_surface_t* surface, bool outlines)
    : surface_(surface), cairo_(cairo_create(surface)), outlines_(outlines) {}

CairoSurface::~CairoSurface() {
  cairo_destroy(cairo_);
  cairo_surface_destroy(surface_);
}

void CairoSurface::check() const {
  check_status(cairo_status(cairo_));
  check_status(cairo_surface_status(surface_));
}

void CairoSurface::boxes(const std::vector<Box>& boxes, Rgb colour) {
  for (const Box& box : boxes) cairo_rectangle(cairo_, box.x, box.y, box.width, box.height);
  set_paint(cairo_, colour);
  cairo_fill(cairo_);
}

void CairoSurface::polygon(const std::vector<Point>& corners, const Paint& paint) {
  add_points(cairo_, corners);
  set_paint(cairo_, paint.colour, paint.opacity);
  cairo_fill(cairo_);
}

void CairoSurface::disc(Point centre, double radius, Rgb colour) {
  cairo_new_sub_path(cairo_);
  cairo_arc(cairo_, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  set_paint(cairo_, colour);
  cairo_fill(cairo_);
}

void CairoSurface::line(const std::vector<LinePart>& parts, double width, Rgb colour, const Box& clip) {
  cairo_save(cairo_);
  cairo_rectangle(cairo_, clip.x, clip.y, clip.width, clip.height);
  cairo_clip(cairo_);
  cairo_set_line_width(cairo_, width);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  set_paint(cairo_, colour);
  for (const LinePart& part : parts) {
    const double dashes[] = {part.dash.on, part.dash.off};
    cairo_set_dash(cairo_, dashes, part.dash.off > 0 ? 2 : 0, part.dash.from);
    add_points(cairo_, part.points);
    cairo_stroke(cairo_);
  }
  cairo_restore(cairo_);
}

void CairoSurface::picture(const Box& box, const std::vector<uint8_t>& rgb) {
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_RGB24, box.width);
  std::vector<uint8_t> rows(size_t(stride) * box.height);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      const uint8_t* from = rgb.data() + (size_t(y) * box.width + x) * 3;
      const uint32_t pixel = uint32_t(from[0]) << 16 | uint32_t(from[1]) << 8 | from[2];
      std::memcpy(rows.data() + size_t(y) * stride + size_t(x) * 4, &pixel, sizeof pixel);
    }
  cairo_surface_t* const source =
      cairo_image_surface_create_for_data(rows.data(), CAIRO_FORMAT_RGB24, box.width, box.height, stride);
  cairo_save(cairo_);
  cairo_set_source_surface(cairo_, source, box.x, box.y);
  cairo_pattern_set_filter(cairo_get_source(cairo_), CAIRO_FILTER_NEAREST);
  cairo_rectangle(cairo_, box.x, box.y, box.width, box.height);
  cairo_fill(cairo_);
  cairo_restore(cairo_);
  // Whoever still needs the pixels copies them before they go.
  cairo_surface_finish(source);
  cairo_surface_destroy(source);
}

void CairoSurface::text(const TextRun& run, const Font& font) {
  const TextShape& shape = font.shape(run.text);
  std::vector<cairo_glyph_t> glyphs;
  for (const TextShape::Glyph& glyph : shape.glyphs)
    glyphs.push_back({glyph.index, glyph.x * run.size, -glyph.y * run.size});
  cairo_save(cairo_);
  cairo_translate(cairo_, run.pen.x, run.pen.y);
  if (run.upwards) cairo_rotate(cairo_, -std::numbers::pi / 2);
  set_font(cairo_, font, run.size);
  set_paint(cairo_, run.colour);
  if (outlines_) {
    cairo_glyph_path(cairo_, glyphs.data(), int(glyphs.size()));
    cairo_fill(cairo_);
  } else {
    const std::vector<cairo_text_cluster_t> clusters = clusters_of(shape, run.text);
    cairo_show_text_glyphs(cairo_, run.text.data(), int(run.text.size()), glyphs.data(), int(glyphs.size()),
                           clusters.data(), int(clusters.size()),
                           shape.leftwards ? CAIRO_TEXT_CLUSTER_FLAG_BACKWARD : cairo_text_cluster_flags_t(0));
  }
  cairo_restore(cairo_);
}

Raster::Raster(int width, int height)
    : CairoSurface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), true),
      pixels_(cairo_image_surface_get_data(surface_)), stride_(cairo_image_surface_get_stride(surface_)) {
  check();
  set_paint(cairo_, {255, 255, 255});
  cairo_paint(cairo_);
}

Rgb Raster::at(int x, int y) const {
  uint32_t pixel;
  std::memcpy(&pixel, pixels_ + size_t(y) * stride_ + size_t(x) * 4, sizeof pixel);
  return {uint8_t(pixel >> 16), uint8_t(pixel >> 8), uint8_t(pixel)};
}

std::string Raster::png(double scale) const {
  check();
  cairo_surface_flush(surface_);
  const int width = cairo_image_surface_get_width(surface_);
  return png_of(width, cairo_image_surface_get_height(surface_), scale, [&](int y, uint8_t* rgb) {
    for (int x = 0; x < width; ++x) {
      const Rgb colour = at(x, y);
      *rgb++ = colour.r;
      *rgb++ = colour.g;
      *rgb++ = colour.b;
    }
  });
}

PdfPage::PdfPage(std::string& to, int width, int height, double scale)
    : CairoSurface(cairo_pdf_surface_create_for_stream(append, &to, width / scale, height / scale), false) {
  check();
  // The same with any cairo: later versions of the format pack what describes a page where no search finds it.
  cairo_pdf_surface_restrict_to_version(surface_, CAIRO_PDF_VERSION_1_4);
  cairo_pdf_surface_set_metadata(surface_, CAIRO_PDF_METADATA_CREATE_DATE, "");
  cairo_scale(cairo_, 1 / scale, 1 / scale);
}

void PdfPage::finish() {
  cairo_show_page(cairo_);
  check_status(cairo_status(cairo_));
  cairo_surface_finish(surface_);
  check();
}

}  // namespace synpo
