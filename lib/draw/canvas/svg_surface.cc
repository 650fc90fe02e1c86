#include "draw/canvas/svg_surface.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include "base/error.h"
#include "draw/canvas/png.h"

namespace synpo {
namespace {

// In pixels, to a hundredth.
std::string number(double value) {
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.2f", value);
  std::string text = digits;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string attribute(const char* name, const std::string& value) { return concat(" ", name, "=\"", value, "\""); }
std::string attribute(const char* name, double value) { return attribute(name, number(value)); }

std::string paint_attribute(const char* name, Rgb colour) {
  char digits[8];
  std::snprintf(digits, sizeof digits, "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return attribute(name, digits);
}

std::string box_attributes(const Box& box) {
  return attribute("x", box.x) + attribute("y", box.y) + attribute("width", box.width) +
         attribute("height", box.height);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string path(const std::vector<Point>& points) {
  std::string out;
  for (const Point& p : points) out += concat(out.empty() ? "M" : "L", number(p.x), " ", number(p.y));
  return out;
}

std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) { return i + k < bytes.size() ? uint32_t(uint8_t(bytes[i + k])) : 0; };
    const uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (int k = 0; k < 4; ++k) out += i + size_t(k) <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace

SvgSurface::SvgSurface(int width, int height, double scale, const Font& font) {
  text_ = concat("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"",
                 attribute("width", number(width / scale) + "pt"), attribute("height", number(height / scale) + "pt"),
                 attribute("viewBox", concat("0 0 ", width, " ", height)),
                 attribute("font-family", concat("'", escaped(font.family()), "', sans-serif")),
                 attribute("xml:space", "preserve"), ">\n");
  boxes({{0, 0, width, height}}, {255, 255, 255});
}

// Borders lie on whole pixels, wherever a viewer that scales them puts those.
void SvgSurface::boxes(const std::vector<Box>& boxes, Rgb colour) {
  const std::string look = paint_attribute("fill", colour) + attribute("shape-rendering", "crispEdges");
  if (boxes.size() == 1) {
    text_ += "<rect" + box_attributes(boxes[0]) + look + "/>\n";
    return;
  }
  std::string d;
  for (const Box& box : boxes)
    d += concat("M", box.x, " ", box.y, "h", box.width, "v", box.height, "h", -box.width, "z");
  text_ += "<path" + attribute("d", d) + look + "/>\n";
}

void SvgSurface::polygon(const std::vector<Point>& corners, const Paint& paint) {
  text_ += "<path" + attribute("d", path(corners) + "z") + paint_attribute("fill", paint.colour);
  if (paint.opacity < 1) text_ += attribute("fill-opacity", paint.opacity);
  text_ += "/>\n";
}

void SvgSurface::disc(Point centre, double radius, Rgb colour) {
  text_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius) +
           paint_attribute("fill", colour) + "/>\n";
}

// What an inner picture shows ends at its border.
void SvgSurface::line(const std::vector<LinePart>& parts, double width, Rgb colour, const Box& clip) {
  text_ += "<svg" + box_attributes(clip) +
           attribute("viewBox", concat(clip.x, " ", clip.y, " ", clip.width, " ", clip.height)) + ">";
  for (const LinePart& part : parts) {
    text_ += "<path" + attribute("d", path(part.points)) + attribute("fill", "none") +
             paint_attribute("stroke", colour) + attribute("stroke-width", width) +
             attribute("stroke-linecap", "round") + attribute("stroke-linejoin", "round");
    if (part.dash.off > 0)
      text_ += attribute("stroke-dasharray", number(part.dash.on) + " " + number(part.dash.off)) +
               attribute("stroke-dashoffset", part.dash.from);
    text_ += "/>";
  }
  text_ += "</svg>\n";
}

void SvgSurface::picture(const Box& box, const std::vector<uint8_t>& rgb) {
  const size_t row = 3 * size_t(box.width);
  const std::string png = png_of(box.width, box.height, 1, [&](int y, uint8_t* to) {
    std::copy_n(rgb.begin() + std::ptrdiff_t(size_t(y) * row), row, to);
  });
  text_ += "<image" + box_attributes(box) + attribute("preserveAspectRatio", "none") +
           attribute("xlink:href", "data:image/png;base64," + base64(png)) + "/>\n";
}

void SvgSurface::text(const TextRun& run, const Font& font) {
  const double along = run.anchor == TextRun::Anchor::kStart ? 0
                       : run.anchor == TextRun::Anchor::kEnd ? font.shape(run.text).advance * run.size
                                                             : font.shape(run.text).advance * run.size / 2;
  const double x = run.upwards ? run.pen.x : run.pen.x + along, y = run.upwards ? run.pen.y - along : run.pen.y;
  text_ += "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", run.size) +
           paint_attribute("fill", run.colour);
  if (run.anchor != TextRun::Anchor::kStart)
    text_ += attribute("text-anchor", run.anchor == TextRun::Anchor::kEnd ? "end" : "middle");
  if (run.upwards) text_ += attribute("transform", concat("rotate(-90 ", number(x), " ", number(y), ")"));
  text_ += ">" + escaped(run.text) + "</text>\n";
}

}  // namespace synpo
