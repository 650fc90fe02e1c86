#include "draw/canvas/png.h"

#include <zlib.h>

#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace synpo {
namespace {

std::string four_bytes(uint32_t n) { return {char(n >> 24), char(n >> 16), char(n >> 8), char(n)}; }

std::string chunk(const char* name, const std::string& bytes) {
  const std::string checked = name + bytes;
  const auto check = uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(checked.data()), checked.size()));
  return four_bytes(uint32_t(bytes.size())) + checked + four_bytes(check);
}

// Bytes as zlib packs them, in chunks.
class Packed {
 public:
  explicit Packed(std::string& to) : to_(to) {
    // Flat areas and letters pack best so, and without a filter.
    if (deflateInit(&stream_, Z_BEST_COMPRESSION) != Z_OK) throw std::bad_alloc();
    more();
  }
  ~Packed() { deflateEnd(&stream_); }
  Packed(const Packed&) = delete;
  Packed& operator=(const Packed&) = delete;

  void add(std::vector<uint8_t>& bytes, int flush) {
    stream_.next_in = bytes.data();
    stream_.avail_in = uInt(bytes.size());
    do {
      if (stream_.avail_out == 0) write();
      deflate(&stream_, flush);
    } while (stream_.avail_in > 0 || stream_.avail_out == 0);
  }
  void write() {
    to_ += chunk("IDAT", packed_.substr(0, packed_.size() - stream_.avail_out));
    more();
  }

 private:
  void more() {
    stream_.next_out = reinterpret_cast<Bytef*>(packed_.data());
    stream_.avail_out = uInt(packed_.size());
  }
  std::string& to_;
  z_stream stream_{};
  std::string packed_ = std::string(size_t{1} << 20, '\0');
};

}  // namespace

std::string png_of(int width, int height, double scale, const std::function<void(int y, uint8_t* rgb)>& row) {
  constexpr double kPointsPerMetre = 72 / 0.0254;
  const std::string per_metre = four_bytes(uint32_t(std::lround(scale * kPointsPerMetre)));
  const std::string eight_bits_of_rgb = {8, 2, 0, 0, 0};
  std::string file = "\x89PNG\r\n\x1a\n";
  file += chunk("IHDR", four_bytes(uint32_t(width)) + four_bytes(uint32_t(height)) + eight_bits_of_rgb);
  file += chunk("pHYs", per_metre + per_metre + '\1');
  Packed packed(file);
  std::vector<uint8_t> bytes(1 + 3 * size_t(width));  // a row begins with its filter, 0: none
  for (int y = 0; y < height; ++y) {
    row(y, bytes.data() + 1);
    packed.add(bytes, y + 1 < height ? Z_NO_FLUSH : Z_FINISH);
  }
  packed.write();
  return file + chunk("IEND", "");
}

}  // namespace synpo
