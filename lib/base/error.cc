#include "base/error.h"

#include <cstdint>
#include <iomanip>

#include "base/text.h"

namespace synpo {
namespace {

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
  const auto [length, code] = character_at(text, at);
  if (length == 0) return "the byte " + printable(text.substr(at, 1));
  const std::string_view character = text.substr(at, length);
  if (character == "\t") return "a tab";
  if (character == "\xc2\xa0") return "a no-break space";
  if (character == "\xef\xbb\xbf") return "a byte order mark";
  const bool blank = (code >= 0x2000 && code <= 0x200f) || code == 0x2028 || code == 0x2029 || code == 0x202f ||
                     code == 0x205f || code == 0x2060 || code == 0x3000 || code == 0xad;
  if (printable_length(text, at) > 0 && !blank) return "'" + std::string(character) + "'";
  std::ostringstream out;
  out << "U+" << std::hex << std::uppercase << std::setw(4) << std::setfill('0') << code;
  return out.str();
}

}  // namespace synpo
