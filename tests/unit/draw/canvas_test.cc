#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/stroke.h"
#include "draw/canvas/ticks.h"
#include "draw/video/video.h"
#include "draw/colour.h"
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
  for (const auto& [width, height] : {std::pair(30'001, 1), std::pair(1, 30'001), std::pair(20'001, 20'000)})
    EXPECT_TRUE(fails_for(kPictureTooLarge, [&] { Canvas(width, height, font()); })) << width;
}

TEST(Font, MissingFontNamesThePackage) {
  EXPECT_THROW(Font("/nonexistent/font.ttf"), Error);
  ASSERT_EQ(setenv("SYNPO_FONT", "/nonexistent/font.ttf", 1), 0);
  EXPECT_THROW(Font(), Error);
  unsetenv("SYNPO_FONT");
}

int ink(const Mask& mask, int x, int y) {
  return mask.coverage[size_t(y - mask.box.y) * mask.box.width + (x - mask.box.x)];
}

TEST(Stroke, CoversItsWidthAndStaysInItsBox) {
  const Box box = {10, 10, 40, 20};
  const Mask mask = stroke_mask({{-1e300, 20}, {1e300, 20}}, 4, {}, box);
  ASSERT_EQ(mask.coverage.size(), 800u);
  for (int x = 10; x < 50; ++x) {
    EXPECT_EQ(ink(mask, x, 16), 0);
    EXPECT_EQ(ink(mask, x, 18), 255);
    EXPECT_EQ(ink(mask, x, 21), 255);
    EXPECT_EQ(ink(mask, x, 23), 0);
  }
  const Mask dashed = stroke_mask({{10, 20}, {50, 20}}, 2, {6, 8}, box);
  EXPECT_EQ(ink(dashed, 13, 20), 255);
  EXPECT_EQ(ink(dashed, 20, 20), 0);
  EXPECT_EQ(ink(dashed, 26, 20), 255);
  EXPECT_EQ(ink(stroke_mask({{30, 20}}, 4, {}, box), 30, 20), 255);
}

TEST(Stroke, BandsLieBetweenTheirLines) {
  const Mask mask = band_mask({{12, 15}, {22, 15}, {40, 12}}, {{12, 18.5}, {22, 18.5}, {40, 25}}, {10, 10, 40, 20});
  EXPECT_EQ(ink(mask, 11, 16), 0);
  EXPECT_EQ(ink(mask, 14, 14), 0);
  EXPECT_EQ(ink(mask, 14, 15), 255);
  EXPECT_EQ(ink(mask, 14, 17), 255);
  EXPECT_NEAR(ink(mask, 14, 18), 128, 1);
  EXPECT_EQ(ink(mask, 14, 19), 0);
  EXPECT_EQ(ink(mask, 39, 20), 255);
  EXPECT_EQ(ink(mask, 41, 20), 0);
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
