#include "draw/video/gif.h"

#include <gif_lib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "base/rgb.h"
#include "draw/video/palette.h"

namespace synpo {
namespace {

constexpr size_t kMostColours = 255;  // and one for pixels that stay as they are
constexpr int kRest = 200;            // hundredths of a second

using Indices = std::vector<uint8_t>;  // [height, width]

int append(GifFileType* gif, const GifByteType* bytes, int count) {
  static_cast<std::string*>(gif->UserData)->append(reinterpret_cast<const char*>(bytes), size_t(count));
  return count;
}

void check(bool done) {
  if (!done) fail(Exit::kInternal, "giflib cannot write an animated GIF");
}

// The part of the picture in which the two differ; a pixel where they do not.
Box changed_box(const Indices& before, const Indices& after, int width, int height) {
  int left = width, right = 0, top = height, bottom = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (const size_t at = size_t(y) * width + x; before[at] == after[at]) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = y + 1;
    }
  return right == 0 ? Box{0, 0, 1, 1} : Box{left, top, right - left, bottom - top};
}

class GifWriter {
 public:
  GifWriter(std::string& bytes, int width, const std::vector<Rgb>& palette)
      : gif_(EGifOpen(&bytes, append, nullptr)), width_(width), unchanged_(int(palette.size())) {
    check(gif_ != nullptr);
    std::vector<GifColorType> colours(std::max<size_t>(2, std::bit_ceil(palette.size() + 1)));
    for (size_t i = 0; i < palette.size(); ++i) colours[i] = {palette[i].r, palette[i].g, palette[i].b};
    map_ = GifMakeMapObject(int(colours.size()), colours.data());
    check(map_ != nullptr);
  }
  ~GifWriter() {
    GifFreeMapObject(map_);
    if (gif_) EGifCloseFile(gif_, nullptr);
  }
  GifWriter(const GifWriter&) = delete;
  GifWriter& operator=(const GifWriter&) = delete;

  void begin(int height) {
    EGifSetGifVersion(gif_, true);
    check(EGifPutScreenDesc(gif_, width_, height, 8, 0, map_));
    // Netscape's extension: over and over.
    constexpr uint8_t kForever[] = {1, 0, 0};
    check(EGifPutExtensionLeader(gif_, APPLICATION_EXT_FUNC_CODE) && EGifPutExtensionBlock(gif_, 11, "NETSCAPE2.0") &&
          EGifPutExtensionBlock(gif_, sizeof kForever, kForever) && EGifPutExtensionTrailer(gif_));
  }

  // What differs from the picture before, where there is one.
  void add(const Indices& before, const Indices& after, int hundredths) {
    const int height = int(after.size()) / width_;
    const Box box = before.empty() ? Box{0, 0, width_, height} : changed_box(before, after, width_, height);
    const GraphicsControlBlock control = {DISPOSE_DO_NOT, false, hundredths,
                                          before.empty() ? NO_TRANSPARENT_COLOR : unchanged_};
    GifByteType extension[4];
    const size_t size = EGifGCBToExtension(&control, extension);
    check(EGifPutExtension(gif_, GRAPHICS_EXT_FUNC_CODE, int(size), extension) &&
          EGifPutImageDesc(gif_, box.x, box.y, box.width, box.height, false, nullptr));
    Indices row(size_t(box.width));
    for (int y = box.y; y < box.bottom(); ++y) {
      for (int x = 0; x < box.width; ++x) {
        const size_t at = size_t(y) * width_ + box.x + x;
        row[size_t(x)] = !before.empty() && before[at] == after[at] ? uint8_t(unchanged_) : after[at];
      }
      check(EGifPutLine(gif_, row.data(), box.width));
    }
  }

  void end() {
    GifFileType* gif = gif_;
    gif_ = nullptr;
    check(EGifCloseFile(gif, nullptr));
  }

 private:
  GifFileType* gif_;
  ColorMapObject* map_ = nullptr;
  int width_, unchanged_;
};

}  // namespace

std::string animated_gif(int frames, double frames_per_second, const std::function<Canvas(int)>& frame) {
  Palette palette;
  int width = 0, height = 0;
  for (int i = 0; i < frames; ++i) {
    const Canvas canvas = frame(i);
    if (i > 0 && (canvas.width() != width || canvas.height() != height))
      fail(Exit::kInternal, "a frame of another size");
    width = canvas.width();
    height = canvas.height();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) palette.add(canvas.at(x, y));
  }
  palette.choose(kMostColours);

  std::string bytes;
  GifWriter writer(bytes, width, palette.colours());
  writer.begin(height);
  Indices before;
  for (int i = 0; i < frames; ++i) {
    const Canvas canvas = frame(i);
    Indices after;
    after.reserve(size_t(width) * height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) after.push_back(uint8_t(palette.index(canvas.at(x, y))));
    // Sums of the rounded times stay true to the rate.
    const auto time = [&](int number) { return int(std::lround(100 * number / frames_per_second)); };
    writer.add(before, after, i + 1 < frames ? time(i + 1) - time(i) : std::max(kRest, time(1)));
    before = std::move(after);
  }
  writer.end();
  return bytes;
}

}  // namespace synpo
