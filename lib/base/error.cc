#include "base/error.h"

#include <cstdint>
#include <iomanip>

#include "base/text.h"

namespace synpo {
namespace {

// Bytes of the character at `at`, or 0 when there is none that is well formed and can be shown as it is: no control
// character, and none that turns the direction of what follows.
size_t printable_length(std::string_view text, size_t at) {
  const size_t length = utf8_length(text, at);
  const auto byte = [&](size_t i) { return uint8_t(text[at + i]); };
  if (length == 1) return byte(0) < 0x20 || byte(0) == 0x7f ? 0 : 1;
  const bool c1_control = length == 2 && byte(0) == 0xc2 && byte(1) < 0xa0;
  const bool direction = (length == 2 && byte(0) == 0xd8 && byte(1) == 0x9c) ||
                         (length == 3 && byte(0) == 0xe2 && byte(1) == 0x80 &&
                          (byte(2) == 0x8e || byte(2) == 0x8f || (byte(2) >= 0xaa && byte(2) <= 0xae))) ||
                         (length == 3 && byte(0) == 0xe2 && byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9);
  return c1_control || direction ? 0 : length;
}

// As printable(), cut where `out` has come to `limit` bytes; whether all of the text is in it.
bool add_printable(std::string_view text, size_t limit, std::string& out) {
  static const char digits[] = "0123456789abcdef";
  size_t i = 0;
  while (i < text.size() && out.size() < limit) {
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
  return i == text.size();
}

}  // namespace

std::string printable(std::string_view text, size_t limit) {
  std::string out;
  return add_printable(text, limit, out) ? out : out + "...";
}

std::string quoted(const std::string& text) {
  constexpr size_t kLimit = 60;
  std::string out = "'";
  return add_printable(text, kLimit, out) ? out + "'" : out + "...'";
}

std::string character_text(std::string_view text, size_t at) {
  const size_t length = utf8_length(text, at);
  if (length == 0) return "the byte " + printable(text.substr(at, 1));
  const std::string_view character = text.substr(at, length);
  if (character == "\t") return "a tab";
  if (character == "\xc2\xa0") return "a no-break space";
  if (character == "\xef\xbb\xbf") return "a byte order mark";
  uint32_t code = uint8_t(character[0]) & (length == 1 ? 0x7f : 0x7f >> length);
  for (const char next : character.substr(1)) code = code << 6 | (uint8_t(next) & 0x3f);
  const bool blank = (code >= 0x2000 && code <= 0x200f) || code == 0x2028 || code == 0x2029 || code == 0x202f ||
                     code == 0x205f || code == 0x2060 || code == 0x3000 || code == 0xad;
  if (printable_length(text, at) > 0 && !blank) return "'" + std::string(character) + "'";
  std::ostringstream out;
  out << "U+" << std::hex << std::uppercase << std::setw(4) << std::setfill('0') << code;
  return out.str();
}

}  // namespace synpo
