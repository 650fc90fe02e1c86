#include "base/error.h"

#include <cstdint>

#include "base/text.h"

namespace synpo {
namespace {

// Bytes of the character at `at`, or 0 when there is none that is well formed and printable.
size_t printable_length(const std::string& text, size_t at) {
  const size_t length = utf8_length(text, at);
  const uint8_t lead = uint8_t(text[at]);
  const bool c1_control = lead == 0xc2 && length == 2 && uint8_t(text[at + 1]) < 0xa0;
  return lead < 0x20 || lead == 0x7f || c1_control ? 0 : length;
}

}  // namespace

std::string quoted(const std::string& text) {
  constexpr size_t kLimit = 60;
  static const char digits[] = "0123456789abcdef";
  std::string out = "'";
  size_t i = 0;
  while (i < text.size() && out.size() < kLimit) {
    if (const size_t length = printable_length(text, i)) {
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
