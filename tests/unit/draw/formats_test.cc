// A canvas as PNG, PDF and SVG.
#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/colour.h"
#include "helpers/font.h"

namespace synpo {
namespace {

Canvas everything(double scale) {
  Canvas canvas(200, 120, font(), scale);
  canvas.fill({10, 10, 30, 20}, {200, 40, 40});
  canvas.fill({{50, 10, 10, 10}, {60, 10, 10, 10}}, {40, 40, 200});
  canvas.squares(80, 10, 5, 2, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 2, 3}});
  canvas.disc({120, 20}, 8.5, {0, 150, 160});
  canvas.line({{10, 40}, {190, 60}}, 1.5, kInk, {6, 8}, {20, 30, 150, 40});
  canvas.polygon({{10, 70}, {40, 70}, {25, 90}}, {0, 114, 178}, 0.25);
  std::vector<uint8_t> rgb;
  for (int i = 0; i < 16 * 16 * 3; ++i) rgb.push_back(uint8_t(i * 7));
  canvas.picture({150, 80, 16, 16}, rgb);
  canvas.text(10, 100, "a < b & \"c\"", 12, kInk);
  canvas.text(190, 100, "success (%)", 12, kInk, Across::kRight, Upright::kBaseline);
  canvas.text_up(60, 90, "upwards", 10, kSoftInk, Across::kCentre);
  return canvas;
}

uint32_t number_at(const std::string& bytes, size_t at) {
  uint32_t n = 0;
  for (size_t i = 0; i < 4; ++i) n = n << 8 | uint8_t(bytes[at + i]);
  return n;
}

// As cairo reads it: [height, width].
std::vector<Rgb> read_png(const std::string& bytes, int width, int height) {
  struct Rest {
    const std::string& bytes;
    size_t at;
  } rest = {bytes, 0};
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(
      [](void* from, unsigned char* to, unsigned count) {
        Rest& left = *static_cast<Rest*>(from);
        if (left.at + count > left.bytes.size()) return CAIRO_STATUS_READ_ERROR;
        std::memcpy(to, left.bytes.data() + left.at, count);
        left.at += count;
        return CAIRO_STATUS_SUCCESS;
      },
      &rest);
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  EXPECT_EQ(cairo_image_surface_get_width(surface), width);
  EXPECT_EQ(cairo_image_surface_get_height(surface), height);
  EXPECT_EQ(rest.at, bytes.size());
  std::vector<Rgb> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      uint32_t pixel;
      std::memcpy(&pixel, cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface) + 4 * x,
                  4);
      out.push_back({uint8_t(pixel >> 16), uint8_t(pixel >> 8), uint8_t(pixel)});
    }
  cairo_surface_destroy(surface);
  return out;
}

TEST(Png, HoldsTheVeryPixels) {
  const Canvas canvas = everything(2);
  const std::string bytes = canvas.png();
  const std::vector<Rgb> read = read_png(bytes, 200, 120);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 200; ++x) ASSERT_EQ(read[size_t(y * 200 + x)], canvas.at(x, y)) << x << ", " << y;
  EXPECT_EQ(bytes, canvas.png());
  EXPECT_EQ(bytes, everything(2).png());
}

TEST(Png, IsInSeveralChunksWhereItIsLarge) {
  Canvas canvas(1200, 900, font());
  std::vector<uint8_t> noise(1200 * 900 * 3);
  uint32_t state = 1;
  for (uint8_t& byte : noise) byte = uint8_t((state = state * 1664525 + 1013904223) >> 24);
  canvas.picture({0, 0, 1200, 900}, noise);
  const std::vector<Rgb> read = read_png(canvas.png(), 1200, 900);
  for (size_t i = 0; i < read.size(); ++i) ASSERT_EQ(read[i], (Rgb{noise[3 * i], noise[3 * i + 1], noise[3 * i + 2]}));
}

TEST(Png, SaysHowLargeItIsOnPaper) {
  for (const auto& [scale, per_metre] : {std::pair(1.0, 2835u), {2.0, 5669u}, {300 / 72.0, 11811u}}) {
    const std::string bytes = everything(scale).png();
    const size_t at = bytes.find("pHYs");
    ASSERT_EQ(at, 8u + 25 + 4) << "right after the header";
    EXPECT_EQ(number_at(bytes, at - 4), 9u);
    EXPECT_EQ(number_at(bytes, at + 4), per_metre);
    EXPECT_EQ(number_at(bytes, at + 8), per_metre);
    EXPECT_EQ(bytes[at + 12], 1) << "metres";
  }
}

TEST(Pdf, IsTheSameTwiceAndOfTheSizeOnPaper) {
  for (const double scale : {1.0, 4.0}) {
    const Canvas canvas = everything(scale);
    const std::string bytes = canvas.pdf();
    EXPECT_TRUE(bytes.starts_with("%PDF-1."));
    EXPECT_TRUE(bytes.ends_with("%%EOF\n"));
    EXPECT_EQ(bytes, canvas.pdf());
    EXPECT_EQ(bytes, everything(scale).pdf());
    EXPECT_EQ(bytes.find("CreationDate"), std::string::npos);
    std::smatch box;
    ASSERT_TRUE(std::regex_search(bytes, box, std::regex("/MediaBox \\[ 0 0 ([0-9.]+) ([0-9.]+) \\]")));
    EXPECT_DOUBLE_EQ(std::stod(box[1]), 200 / scale);
    EXPECT_DOUBLE_EQ(std::stod(box[2]), 120 / scale);
  }
}

TEST(Pdf, EmbedsTheLettersThatAreShown) {
  const std::string bytes = everything(4).pdf();
  EXPECT_NE(bytes.find("+DejaVuSans"), std::string::npos);
  EXPECT_NE(bytes.find("/FontFile2"), std::string::npos);
  EXPECT_NE(bytes.find("/ToUnicode"), std::string::npos) << "else it could not be searched";
  EXPECT_EQ(Canvas(10, 10, font()).pdf().find("/FontFile2"), std::string::npos);
}

// What an element with this text has for an attribute.
std::string attribute(const std::string& svg, const std::string& text, const std::string& name) {
  const size_t end = svg.find(">" + text + "</text>"), begin = svg.rfind('<', end);
  EXPECT_NE(end, std::string::npos) << text;
  std::smatch found;
  const std::string element = svg.substr(begin, end - begin);
  return std::regex_search(element, found, std::regex(" " + name + "=\"([^\"]*)\"")) ? found[1] : std::string();
}

TEST(Svg, TextIsTextWhereItStands) {
  const Canvas canvas = everything(4);
  const std::string svg = canvas.svg();
  EXPECT_EQ(svg, canvas.svg());
  EXPECT_NE(svg.find("width=\"50pt\" height=\"30pt\" viewBox=\"0 0 200 120\""), std::string::npos);
  EXPECT_NE(svg.find("font-family=\"'DejaVu Sans', sans-serif\""), std::string::npos);
  const std::string escaped = "a &lt; b &amp; &quot;c&quot;";
  // The ink of an a begins 0.06 em after its pen.
  EXPECT_NEAR(std::stod(attribute(svg, escaped, "x")), 10 - 0.06 * 12, 0.02);
  EXPECT_EQ(attribute(svg, escaped, "y"), "109") << "a digit is 0.73 em high";
  EXPECT_EQ(attribute(svg, escaped, "font-size"), "12");
  EXPECT_EQ(attribute(svg, escaped, "text-anchor"), "");
  EXPECT_EQ(attribute(svg, "success (%)", "text-anchor"), "end");
  EXPECT_EQ(attribute(svg, "success (%)", "y"), "100");
  EXPECT_NEAR(std::stod(attribute(svg, "success (%)", "x")), 190, 2);
  EXPECT_EQ(attribute(svg, "upwards", "text-anchor"), "middle");
  EXPECT_NEAR(std::stod(attribute(svg, "upwards", "y")), 90, 1);
  EXPECT_EQ(attribute(svg, "upwards", "transform"),
            "rotate(-90 " + attribute(svg, "upwards", "x") + " " + attribute(svg, "upwards", "y") + ")");
}

TEST(Svg, ShapesHaveTheirPlacesAndColours) {
  const std::string svg = everything(4).svg();
  for (const char* shape :
       {"<rect x=\"10\" y=\"10\" width=\"30\" height=\"20\" fill=\"#c82828\"",
        "<path d=\"M50 10h10v10h-10zM60 10h10v10h-10z\" fill=\"#2828c8\"",
        "<circle cx=\"120\" cy=\"20\" r=\"8.5\" fill=\"#0096a0\"", "fill=\"#0072b2\" fill-opacity=\"0.25\"",
        "<svg x=\"20\" y=\"30\" width=\"150\" height=\"40\" viewBox=\"20 30 150 40\">",
        "stroke-width=\"1.5\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-dasharray=\"6 8\"",
        "<image x=\"150\" y=\"80\" width=\"16\" height=\"16\" preserveAspectRatio=\"none\" "
        "xlink:href=\"data:image/png;base64,iVBORw0KGgo"})
    EXPECT_NE(svg.find(shape), std::string::npos) << shape;
}

TEST(Formats, ANameThatIsNoUtf8IsDrawnAllTheSame) {
  Canvas canvas(100, 30, font());
  canvas.text(5, 5,
              "a\xff"
              "b\x01",
              12, kInk);
  EXPECT_NE(canvas.svg().find(">a\uFFFDb\uFFFD</text>"), std::string::npos);
  EXPECT_FALSE(canvas.pdf().empty());
  EXPECT_FALSE(canvas.png().empty());
}

TEST(Font, SaysWhatItLacks) {
  const Font own;
  own.width("caf\u00e9 \u6f22 \u6f22\u5b57", 10);
  EXPECT_EQ(own.missing(), (std::set<std::string>{"\u6f22", "\u5b57"}));
  EXPECT_EQ(own.family(), "DejaVu Sans");
}

TEST(Font, WidthsGrowWithTheSize) {
  const std::string text = "success rate";
  const TextShape& shape = font().shape(text);
  EXPECT_EQ(shape.glyphs.size(), text.size());
  for (const int size : {5, 9, 17, 100})
    EXPECT_EQ(font().width(text, size), int(std::ceil(size * (shape.right - shape.left) - 1e-6)));
  EXPECT_EQ(font().width("", 10), 0);
  EXPECT_EQ(font().width(" ", 10), 0);
  // A mark over a letter is a part of it, and what is read from the right has its first letter there.
  EXPECT_EQ(font().width("e\u0301", 100), font().width("\u00e9", 100));
  EXPECT_TRUE(font().shape("\u05d0\u05d1").leftwards);
  EXPECT_EQ(font().shape("\u05d0\u05d1").glyphs.front().begin, 2u);
}

}  // namespace
}  // namespace synpo
