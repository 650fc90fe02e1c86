#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/shapes.h"
#include "draw/canvas/ticks.h"
#include "draw/colour.h"
#include "draw/video/video.h"
#include "helpers/font.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(Text, FittedKeepsBothEndsAndFits) {
  const std::string name = "kitchen-with-a-long-name-FloorPlan12";
  for (int width = 40; width < 400; width += 23) {
    const std::string fitted = font().fitted(name, 17, width);
    EXPECT_LE(font().width(fitted, 17), width);
  }
  EXPECT_EQ(font().fitted("map12", 17, 400), "map12");
  // Measured at once, this would take gigabytes.
  const std::string endless = font().fitted(std::string(1000000, 'x') + "end", 17, 200);
  EXPECT_LE(font().width(endless, 17), 200);
  EXPECT_TRUE(endless.ends_with("xend"));
  const std::string cut = font().fitted(name, 17, 150);
  EXPECT_EQ(cut.front(), 'k');
  EXPECT_EQ(cut.back(), '2');
  // Whole characters only.
  EXPECT_EQ(font().fitted("\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9", 17, 45).size() % 2, 1u);
}

TEST(Text, NamesThatAreShortenedStayDifferent) {
  const std::string head = "a-rather-long-beginning-", tail = "-and-a-rather-long-end-of-all-names";
  std::vector<std::string> names;
  for (const char* middle : {"fridge", "microwave", "sink", "sink"}) names.push_back(head + middle + tail);
  const std::vector<std::string> fitted = font().fitted_apart(names, 17, 150);
  EXPECT_EQ(std::set<std::string>(fitted.begin(), fitted.end()).size(), 3u);
  EXPECT_EQ(fitted[2], fitted[3]) << "names that are equal stay so";
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LE(font().width(fitted[i], 17), 150) << fitted[i];
    EXPECT_NE(fitted[i].find(names[i].substr(head.size(), 4)), std::string::npos) << fitted[i];
  }
  // Those that differ at an end are cut in the middle, and what fits is left alone.
  EXPECT_EQ(font().fitted_apart({"map1", "map2"}, 17, 150), (std::vector<std::string>{"map1", "map2"}));
  // What cannot be told apart otherwise has a number.
  const std::string same(60, 'x');
  const std::vector<std::string> numbered =
      font().fitted_apart({same + "1" + same + "2" + same, same + "2" + same + "1" + same + "x"}, 17, 60);
  EXPECT_NE(numbered[0], numbered[1]);
  for (const std::string& name : numbered) EXPECT_LE(font().width(name, 17), 62) << name;
}

TEST(Text, WrappedLinesFit) {
  const auto lines = font().wrapped("one two three four five six seven " + std::string(80, 'w'), 20, 150);
  EXPECT_GT(lines.size(), 3u);
  for (const std::string& line : lines) EXPECT_LE(font().width(line, 20), 150);
}

TEST(Text, ClippingIsCounted) {
  Canvas canvas(60, 30, font());
  canvas.text(2, 2, "in", 12, kInk);
  EXPECT_EQ(canvas.clipped(), 0);
  canvas.text(40, 2, "out of it", 12, kInk);
  EXPECT_GT(canvas.clipped(), 0);
}

TEST(Canvas, TooLargeAPictureIsRefused) {
  for (const auto& size : {std::pair(30'001, 1), std::pair(1, 30'001), std::pair(20'001, 20'000)})
    EXPECT_TRUE(fails_for(kPictureTooLarge, [&] { Canvas(size.first, size.second, font()); })) << size.first;
}

TEST(Font, MissingFontNamesThePackage) {
  EXPECT_THROW(Font("/nonexistent/font.ttf"), Error);
  ASSERT_EQ(setenv("SYNPO_FONT", "/nonexistent/font.ttf", 1), 0);
  EXPECT_THROW(Font(), Error);
  unsetenv("SYNPO_FONT");
}

// How much of a pixel what is drawn in black covers, 0 to 255.
int ink(const Canvas& canvas, int x, int y) { return 255 - canvas.at(x, y).r; }

constexpr Rgb kBlack = {0, 0, 0};

TEST(Line, CoversItsWidthAndStaysInItsBox) {
  const Box box = {10, 10, 40, 20};
  Canvas canvas(60, 40, font());
  canvas.line({{-1e300, 20}, {1e300, 20}}, 4, kBlack, {}, box);
  for (int x = 10; x < 50; ++x) {
    EXPECT_EQ(ink(canvas, x, 16), 0);
    EXPECT_EQ(ink(canvas, x, 18), 255);
    EXPECT_EQ(ink(canvas, x, 21), 255);
    EXPECT_EQ(ink(canvas, x, 23), 0);
  }
  for (int y = 0; y < 40; ++y)
    for (const int x : {9, 50}) EXPECT_EQ(ink(canvas, x, y), 0);
  Canvas dashed(60, 40, font());
  dashed.line({{10, 20}, {50, 20}}, 2, kBlack, {6, 8}, box);
  EXPECT_EQ(ink(dashed, 13, 20), 255);
  EXPECT_EQ(ink(dashed, 20, 20), 0);
  EXPECT_EQ(ink(dashed, 26, 20), 255);
  Canvas dot(60, 40, font());
  dot.line({{30, 20}}, 4, kBlack, {}, box);
  EXPECT_EQ(ink(dot, 30, 20), 255);
  EXPECT_EQ(ink(dot, 27, 20), 255) << "twice as wide as the line";
  EXPECT_EQ(ink(dot, 25, 20), 0);
}

TEST(Line, ThatComesFromAfarHasTheDashesOfTheWholeLine) {
  Canvas near(60, 40, font()), far(60, 40, font());
  near.line({{-14, 20}, {74, 20}}, 2, kBlack, {6, 8});
  far.line({{-14 - 14e5, 20}, {-14 - 7e5, 20}, {74 + 14e5, 20}}, 2, kBlack, {6, 8});
  for (int x = 0; x < 60; ++x) EXPECT_NEAR(ink(near, x, 20), ink(far, x, 20), 2) << x;
  // Out of the picture and in again.
  const std::vector<LinePart> parts =
      visible_parts({{0, 20}, {0, -500}, {40, -500}, {40, 20}}, 2, {6, 8}, {0, 0, 60, 40});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_DOUBLE_EQ(parts[1].points.front().y, -2);
  EXPECT_NEAR(parts[1].dash.from, std::fmod(520 + 40 + 498, 14), 1e-9);
}

TEST(Polygon, BandsLieBetweenTheirLines) {
  Canvas canvas(60, 40, font());
  canvas.polygon({{12, 15}, {22, 15}, {40, 12}, {40, 25}, {22, 18.6}, {12, 18.6}}, kBlack, 1, {10, 10, 40, 20});
  EXPECT_EQ(ink(canvas, 11, 16), 0);
  EXPECT_EQ(ink(canvas, 14, 14), 0);
  EXPECT_EQ(ink(canvas, 14, 15), 255);
  EXPECT_EQ(ink(canvas, 14, 17), 255);
  EXPECT_NEAR(ink(canvas, 14, 18), 153, 1) << "nine of the fifteen rows of a pixel that cairo looks at";
  EXPECT_EQ(ink(canvas, 14, 19), 0);
  EXPECT_EQ(ink(canvas, 39, 20), 255);
  EXPECT_EQ(ink(canvas, 41, 20), 0);
}

TEST(Polygon, EndsAtItsBox) {
  Canvas canvas(60, 40, font());
  canvas.polygon({{-1e300, -1e300}, {1e300, -1e300}, {1e300, 1e300}, {-1e300, 1e300}}, kBlack, 0.5, {10, 10, 40, 20});
  for (const auto& [x, y] : {std::pair(10, 10), {49, 10}, {49, 29}, {10, 29}}) EXPECT_NEAR(ink(canvas, x, y), 127.5, 1);
  for (const auto& [x, y] : {std::pair(9, 10), {50, 10}, {49, 30}, {10, 9}}) EXPECT_EQ(ink(canvas, x, y), 0);
}

TEST(Canvas, SquaresAndShadesHaveTheirColours) {
  Canvas canvas(30, 30, font());
  std::vector<Rgb> colours;
  for (int i = 0; i < 9; ++i) colours.push_back(i % 4 ? kBlack : Rgb{uint8_t(20 * i), 50, 60});
  canvas.squares(0, 0, 10, 3, colours);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) ASSERT_EQ(canvas.at(x, y), colours[size_t(y / 10 * 3 + x / 10)]) << x << ", " << y;
  canvas.shades({5, 5, 10, 11}, [](double share) { return Rgb{uint8_t(std::lround(100 * share)), 0, 0}; });
  for (int y = 0; y < 11; ++y) EXPECT_EQ(canvas.at(14, 5 + y).r, 10 * y);
  EXPECT_EQ(canvas.at(15, 5), colours[1]);
}

std::vector<std::string> labels(double low, double high, int most) {
  const Ticks ticks = nice_ticks(low, high, most);
  std::vector<std::string> out;
  for (const double at : ticks.at) out.push_back(tick_text(at, ticks.step));
  return out;
}

using Texts = std::vector<std::string>;

TEST(Ticks, StandAtOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(labels(0, 100, 6), (Texts{"0", "20", "40", "60", "80", "100"}));
  EXPECT_EQ(labels(0, 100, 5), (Texts{"0", "50", "100"}));
  EXPECT_EQ(labels(0, 1, 11), (Texts{"0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1.0"}));
  EXPECT_EQ(labels(-3.2, 9.7, 5), (Texts{"0", "5"}));
  EXPECT_EQ(labels(-6, 3, 7), (Texts{"\u22126", "\u22124", "\u22122", "0", "2"}));
  EXPECT_EQ(labels(0.0012, 0.0031, 3), (Texts{"0.002", "0.003"}));
  EXPECT_EQ(labels(1e9, 2e9, 3), (Texts{"1e+09", "1.5e+09", "2e+09"}));
}

TEST(Ticks, AreInsideEvenlySpacedAndNoMoreThanAskedFor) {
  for (const double low : {-123.4, -1.0, 0.0, 0.037, 55.5})
    for (const double range : {1e-5, 0.013, 0.7, 1.0, 9.99, 480.0, 3e8})
      for (int most = 2; most <= 12; ++most) {
        const Ticks ticks = nice_ticks(low, low + range, most);
        ASSERT_LE(int(ticks.at.size()), most);
        // At worst half as many as there may be, less one for where they happen to lie.
        EXPECT_GE(int(ticks.at.size()), std::max(0, (most - 1) * 2 / 5 - 1)) << low << " + " << range << ", " << most;
        for (size_t i = 0; i < ticks.at.size(); ++i) {
          EXPECT_GE(ticks.at[i], low - 1e-6 * range);
          EXPECT_LE(ticks.at[i], low + range + 1e-6 * range);
          if (i > 0) {
            EXPECT_NEAR(ticks.at[i] - ticks.at[i - 1], ticks.step, 1e-6 * ticks.step);
          }
        }
      }
  EXPECT_THROW(nice_ticks(1, 1, 5), Error);
  EXPECT_THROW(nice_ticks(-1e300, 1e300, 5), Error);
  EXPECT_THROW(nice_ticks(1e9, 1e9 + 1e-3, 5), Error);
}

TEST(Ticks, OfALogarithmicAxisStandAtPowersOfTenAndBetween) {
  const auto labels = [](double low, double high, int most) {
    const Axis axis = {low, high, 1, "", true};
    const Ticks ticks = axis.ticks(most);
    std::vector<std::string> out;
    for (const double at : ticks.at) out.push_back(axis.label(at, ticks));
    return out;
  };
  EXPECT_EQ(labels(1, 100, 8), (Texts{"1", "2", "5", "10", "20", "50", "100"}));
  EXPECT_EQ(labels(1, 100, 6), (Texts{"1", "10", "100"}));
  EXPECT_EQ(labels(0.03, 30, 9), (Texts{"0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10", "20"}));
  EXPECT_EQ(labels(1e-4, 1e4, 4), (Texts{"0.001", "1", "1000"}));
  const Axis axis = {0.1, 1000, 1, "", true};
  EXPECT_DOUBLE_EQ(axis.place(0.1), 0);
  EXPECT_NEAR(axis.place(10), 0.5, 1e-12);
  EXPECT_NEAR(axis.place(1000), 1, 1e-12);
  EXPECT_LT(axis.place(0), 0);
  EXPECT_LT(axis.place(-5), 0);
}

TEST(Ticks, CountsAreWrittenInThousandsAndMillions) {
  const Axis axis = count_axis("states", 0, 8.7e6);
  EXPECT_EQ(axis.title, "states (millions)");
  const Ticks ticks = axis.ticks(10);
  EXPECT_EQ(axis.label(ticks.at[1], ticks), "1");
  EXPECT_EQ(count_axis("updates", 0, 17000).title, "updates");
  EXPECT_EQ(count_axis("updates", 0, 200000).title, "updates (thousands)");
}

TEST(Ticks, AxesOfValuesEndAtTicks) {
  EXPECT_DOUBLE_EQ(value_axis("", -2.9, 9.1, 7).low, -4);
  EXPECT_DOUBLE_EQ(value_axis("", -2.9, 9.1, 7).high, 10);
  EXPECT_DOUBLE_EQ(value_axis("", 0.5, 4.6, 6).low, 0);
  EXPECT_DOUBLE_EQ(value_axis("", 4.1, 4.6, 6).low, 4.1);
  const Axis flat = value_axis("", 7, 7, 5);
  EXPECT_LT(flat.low, 7);
  EXPECT_GT(flat.high, 7);
}

TEST(Video, IsWholeOrNotThere) {
  const TemporaryFolder folder;
  Canvas frame(320, 200, font());
  frame.disc({100, 100}, 60, {200, 40, 40});
  {
    Video video(folder.file("a.avi"), 5, frame.width(), frame.height());
    video.add(frame);
    EXPECT_EQ(folder.files(), 1u);
  }
  EXPECT_EQ(folder.files(), 0u);
  for (const char* name : {"a.avi", "b.avi"}) {
    Video video(folder.file(name), 5, frame.width(), frame.height());
    for (int i = 0; i < 3; ++i) video.add(frame);
    video.finish();
  }
  EXPECT_EQ(folder.files(), 2u);
  EXPECT_EQ(contents(folder.file("a.avi")), contents(folder.file("b.avi")));
  EXPECT_THROW(Video(folder.file("c.png"), 5, 16, 16), Error);
  EXPECT_THROW(Video(folder.file("none/c.avi"), 5, 16, 16), Error);
  EXPECT_EQ(folder.files(), 2u);
}

}  // namespace
}  // namespace synpo
