#include "draw/video/gif.h"

#include <gif_lib.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/colour.h"
#include "draw/video/palette.h"
#include "helpers/font.h"

namespace synpo {
namespace {

// A GIF as giflib reads it.
class Read {
 public:
  explicit Read(const std::string& bytes) : bytes_(bytes), gif_(DGifOpen(this, read, nullptr)) {
    EXPECT_EQ(DGifSlurp(gif_), GIF_OK);
    std::vector<Rgb> screen(size_t(gif_->SWidth) * gif_->SHeight);
    for (int i = 0; i < gif_->ImageCount; ++i) {
      const SavedImage& image = gif_->SavedImages[i];
      GraphicsControlBlock control;
      EXPECT_EQ(DGifSavedExtensionToGCB(gif_, i, &control), GIF_OK);
      EXPECT_EQ(control.DisposalMode, DISPOSE_DO_NOT);
      delays.push_back(control.DelayTime);
      const GifImageDesc& at = image.ImageDesc;
      written += int64_t{at.Width} * at.Height;
      for (int y = 0; y < at.Height; ++y)
        for (int x = 0; x < at.Width; ++x) {
          const int index = image.RasterBits[y * at.Width + x];
          if (index == control.TransparentColor) continue;
          const GifColorType& colour = gif_->SColorMap->Colors[index];
          screen[size_t(at.Top + y) * gif_->SWidth + at.Left + x] = {colour.Red, colour.Green, colour.Blue};
        }
      frames.push_back(screen);
    }
  }
  ~Read() { DGifCloseFile(gif_, nullptr); }

  std::vector<std::vector<Rgb>> frames;  // as they are seen
  std::vector<int> delays;
  int64_t written = 0;  // pixels in the file

 private:
  static int read(GifFileType* gif, GifByteType* to, int count) {
    Read& self = *static_cast<Read*>(gif->UserData);
    const int got = std::min(count, int(self.bytes_.size() - self.at_));
    std::memcpy(to, self.bytes_.data() + self.at_, size_t(got));
    self.at_ += size_t(got);
    return got;
  }
  const std::string& bytes_;
  size_t at_ = 0;
  GifFileType* gif_;
};

// A square that goes right, one step a frame.
Canvas square(int moment) {
  Canvas canvas(80, 30, font());
  canvas.text(2, 2, "go", 12, kInk);
  canvas.fill({4 + 10 * std::min(moment, 5), 18, 8, 8}, {200, 40, 40});
  return canvas;
}

void expect_shows(const std::vector<Rgb>& seen, const Canvas& canvas) {
  ASSERT_EQ(seen.size(), size_t(canvas.width()) * canvas.height());
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      ASSERT_EQ(seen[size_t(y) * canvas.width() + x], canvas.at(x, y)) << x << ", " << y;
}

TEST(Gif, ShowsEveryFrameAsItWasDrawn) {
  const std::string bytes = animated_gif(7, 8, square);
  const Read gif(bytes);
  ASSERT_EQ(gif.frames.size(), 7u);
  for (int i = 0; i < 7; ++i) expect_shows(gif.frames[i], square(i));
  // Of a later frame only what has changed: the old and the new place of the square, and one pixel where nothing did.
  EXPECT_EQ(gif.written, 80 * 30 + 5 * 18 * 8 + 1);
  EXPECT_NE(bytes.find("NETSCAPE2.0\3\1"), std::string::npos);
  EXPECT_EQ(bytes, animated_gif(7, 8, square));
}

TEST(Gif, KeepsTheRateAndRestsAtTheEnd) {
  // Eight frames a second last 12.5 hundredths each, and no sum of them is off by more than a half.
  const std::vector<int> delays = Read(animated_gif(5, 8, square)).delays;
  EXPECT_EQ(delays, (std::vector{13, 12, 13, 12, 200}));
  EXPECT_EQ(Read(animated_gif(1, 8, square)).delays, std::vector{200});
  EXPECT_EQ(Read(animated_gif(2, 0.1, square)).delays, (std::vector{1000, 1000}));
}

TEST(Gif, OfOneColourCanBeRead) {
  const auto white = [](int) { return Canvas(5, 5, font()); };
  expect_shows(Read(animated_gif(1, 8, white)).frames[0], white(0));
}

TEST(Palette, IsExactWhereItHoldsAllColours) {
  Palette palette;
  for (int i = 0; i < 255; ++i) palette.add({uint8_t(i), 0, 0});
  palette.choose(255);
  ASSERT_EQ(palette.colours().size(), 255u);
  for (int i = 0; i < 255; ++i) {
    const Rgb colour = {uint8_t(i), 0, 0};
    EXPECT_EQ(palette.colours()[size_t(palette.index(colour))], colour);
  }
}

TEST(Palette, KeepsWhatIsSeenMostAndStaysNearTheRest) {
  Palette palette;
  const Rgb walls = {62, 70, 82}, floor = {250, 249, 245};
  for (int i = 0; i < 100'000; ++i) palette.add(i % 3 ? walls : floor);
  std::vector<Rgb> others;
  for (int i = 0; i < 4096; ++i)
    others.push_back({uint8_t(i % 16 * 17), uint8_t(i / 16 % 16 * 17), uint8_t(i / 256 * 17)});
  for (const Rgb& colour : others) palette.add(colour);
  palette.choose(255);
  EXPECT_EQ(palette.colours().size(), 255u);
  for (const Rgb& colour : {walls, floor}) EXPECT_EQ(palette.colours()[size_t(palette.index(colour))], colour);
  // A cube of 255 equal ones has a side of 256 / 6.3.
  for (const Rgb& colour : others) {
    const Rgb shown = palette.colours()[size_t(palette.index(colour))];
    EXPECT_LE(std::max({std::abs(shown.r - colour.r), std::abs(shown.g - colour.g), std::abs(shown.b - colour.b)}), 51);
  }
}

}  // namespace
}  // namespace synpo
