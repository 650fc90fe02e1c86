#include "base/error.h"

namespace synpo {
namespace {

// Length of the UTF-8 sequence at `at`, or 0 when there is none that is well formed and printable.
size_t utf8_length(const std::string& text, size_t at) {
  const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : 0; };
  const uint8_t lead = byte(at);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const size_t length = lead >= 0xf0 && lead < 0xf5 ? 4 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xc2 && lead < 0xe0 ? 2 : 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  const bool c1_control = lead == 0xc2 && byte(at + 1) < 0xa0;
  return c1_control ? 0 : length;
}

}  // namespace

std::string quoted(const std::string& text) {
  constexpr size_t kLimit = 60;
  static const char digits[] = "0123456789abcdef";
  std::string out = "'";
  size_t i = 0;
  while (i < text.size() && out.size() < kLimit) {
    if (const size_t length = utf8_length(text, i)) {
      out.append(text, i, length);
      i += length;
    } else {
      const uint8_t byte = uint8_t(text[i++]);
      out += "\\x";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    }
  }
  return out + (i < text.size() ? "...'" : "'");
}

}  // namespace synpo
