#include "draw/canvas/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "draw/canvas/cairo_surface.h"
#include "draw/canvas/surface.h"
#include "draw/canvas/svg_surface.h"

namespace synpo {
namespace {

// A name of a file may be any bytes.
std::string valid_text(std::string text) {
  for (size_t bad; (bad = first_bad_byte(text)) != std::string::npos;) text.replace(bad, 1, "\uFFFD");
  return text;
}

Box common(const Box& a, const Box& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::min(a.right(), b.right()) - x, std::min(a.bottom(), b.bottom()) - y};
}

double area_of(double width, double height) { return std::max(width, 0.0) * std::max(height, 0.0); }

}  // namespace

Canvas::Canvas(int width, int height, const Font& font, double scale)
    : width_(width), height_(height), scale_(scale), font_(font) {
  constexpr int kLongest = 30000;
  constexpr int64_t kMost = 400'000'000;
  if (width > kLongest || height > kLongest || int64_t{width} * height > kMost)
    fail(Exit::kUsage, kPictureTooLarge, "the picture would have ", width, " x ", height, " pixels");
}

Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;

void Canvas::draw(std::function<void(Surface&)> shape) { shapes_.push_back(std::move(shape)); }

void Canvas::fill(const Box& box, Rgb colour) {
  const Box seen = common(box, whole());
  if (seen.width <= 0 || seen.height <= 0) return;
  draw([=](Surface& to) { to.boxes({seen}, colour); });
}

void Canvas::fill(const std::vector<Box>& boxes, Rgb colour) {
  std::vector<Box> seen;
  for (const Box& box : boxes)
    if (const Box part = common(box, whole()); part.width > 0 && part.height > 0) seen.push_back(part);
  if (seen.empty()) return;
  draw([seen = std::move(seen), colour](Surface& to) { to.boxes(seen, colour); });
}

// On a ground of the colour that is most of it, what has another one: no seam shows paper.
void Canvas::squares(int x, int y, int side, int columns, const std::vector<Rgb>& colours) {
  const auto key = [](Rgb colour) { return std::tuple(colour.r, colour.g, colour.b); };
  std::map<std::tuple<uint8_t, uint8_t, uint8_t>, std::vector<Box>> boxes;
  std::map<std::tuple<uint8_t, uint8_t, uint8_t>, size_t> counts;
  const int count = int(colours.size());
  for (int i = 0; i < count;) {
    int end = i + 1;
    while (end < count && end % columns != 0 && colours[size_t(end)] == colours[size_t(i)]) ++end;
    boxes[key(colours[size_t(i)])].push_back({x + i % columns * side, y + i / columns * side, (end - i) * side, side});
    counts[key(colours[size_t(i)])] += size_t(end - i);
    i = end;
  }
  if (boxes.empty()) return;
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto colour_of = [](const auto& of) { return Rgb{std::get<0>(of), std::get<1>(of), std::get<2>(of)}; };
  fill({x, y, std::min(columns, count) * side, (count + columns - 1) / columns * side}, colour_of(most->first));
  for (const auto& [colour, of_it] : boxes)
    if (colour != most->first) fill(of_it, colour_of(colour));
}

// Each row reaches down to the end, lest seams show.
void Canvas::shades(const Box& box, const std::function<Rgb(double share)>& colour) {
  for (int row = 0; row < box.height; ++row)
    fill({box.x, box.y + row, box.width, box.height - row}, colour(double(row) / std::max(1, box.height - 1)));
}

void Canvas::frame(const Box& box, int line, Rgb colour) {
  fill({box.x, box.y, box.width, line}, colour);
  fill({box.x, box.bottom() - line, box.width, line}, colour);
  fill({box.x, box.y, line, box.height}, colour);
  fill({box.right() - line, box.y, line, box.height}, colour);
}

void Canvas::polygon(const std::vector<Point>& corners, Rgb colour, double opacity) {
  polygon(corners, colour, opacity, whole());
}

void Canvas::polygon(const std::vector<Point>& corners, Rgb colour, double opacity, const Box& clip) {
  draw([seen = clipped_polygon(corners, clip), paint = Paint{colour, opacity}](Surface& to) {
    if (!seen.empty()) to.polygon(seen, paint);
  });
}

void Canvas::disc(Point centre, double radius, Rgb colour) {
  draw([=](Surface& to) { to.disc(centre, radius, colour); });
}

void Canvas::line(const std::vector<Point>& points, double width, Rgb colour, const Dash& dash) {
  line(points, width, colour, dash, whole());
}

void Canvas::line(const std::vector<Point>& points, double width, Rgb colour, const Dash& dash, const Box& clip) {
  std::vector<LinePart> parts = visible_parts(points, width, dash, clip);
  if (parts.empty()) return;
  const bool is_dot = points.size() == 1;
  if (is_dot) parts[0].points.push_back(parts[0].points[0]);
  draw([=](Surface& to) { to.line(parts, is_dot ? 2 * width : width, colour, clip); });
}

void Canvas::picture(const Box& box, std::vector<uint8_t> rgb) {
  draw([box, rgb = std::move(rgb)](Surface& to) { to.picture(box, rgb); });
}

void Canvas::text(int x, int y, const std::string& text, int size, Rgb colour, Across across, Upright upright) {
  const double digit = size * font_.shape("0").top;
  const double baseline = upright == Upright::kBaseline ? y : upright == Upright::kMiddle ? y + digit / 2 : y + digit;
  write(text, {double(x), std::round(baseline)}, size, colour, false, across);
}

void Canvas::text_up(int x, int y, const std::string& text, int size, Rgb colour, Across along) {
  write(text, {std::round(x + size * font_.shape("0").top / 2), double(y)}, size, colour, true, along);
}

// The point is where ink begins, has its middle or ends, on the baseline.
void Canvas::write(const std::string& text, Point point, int size, Rgb colour, bool upwards, Across across) {
  const std::string valid = valid_text(text);
  const TextShape& shape = font_.shape(valid);
  if (shape.glyphs.empty()) return;
  const double left = size * shape.left, right = size * shape.right;
  const double before = across == Across::kLeft ? left : across == Across::kCentre ? (left + right) / 2 : right;
  const Point pen = upwards ? Point{point.x, point.y + before} : Point{point.x - before, point.y};
  const auto anchor = across == Across::kLeft     ? TextRun::Anchor::kStart
                      : across == Across::kCentre ? TextRun::Anchor::kMiddle
                                                  : TextRun::Anchor::kEnd;
  // The ink, and of it what can be seen.
  const double top = size * shape.top, bottom = size * shape.bottom;
  const double x0 = upwards ? pen.x - top : pen.x + left, x1 = upwards ? pen.x - bottom : pen.x + right;
  const double y0 = upwards ? pen.y - right : pen.y - top, y1 = upwards ? pen.y - left : pen.y - bottom;
  clipped_ += area_of(x1 - x0, y1 - y0) - area_of(std::min(x1, double(width_)) - std::max(x0, 0.0),
                                                  std::min(y1, double(height_)) - std::max(y0, 0.0));
  draw([run = TextRun{valid, pen, size, colour, upwards, anchor}, &font = font_](Surface& to) { to.text(run, font); });
}

const Raster& Canvas::raster() const {
  if (!raster_) raster_ = std::make_unique<Raster>(width_, height_);
  for (; rastered_ < shapes_.size(); ++rastered_) shapes_[rastered_](*raster_);
  return *raster_;
}

Rgb Canvas::at(int x, int y) const { return raster().at(x, y); }

std::string Canvas::png() const { return raster().png(scale_); }

std::string Canvas::pdf() const {
  std::string bytes;
  PdfPage page(bytes, width_, height_, scale_);
  for (const auto& shape : shapes_) shape(page);
  page.finish();
  return bytes;
}

std::string Canvas::svg() const {
  SvgSurface surface(width_, height_, scale_, font_);
  for (const auto& shape : shapes_) shape(surface);
  return surface.svg();
}

}  // namespace synpo
