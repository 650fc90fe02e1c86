#include "base/error.h"

#include <algorithm>
#include <cstdint>
#include <iomanip>
#include <span>

#include "base/text.h"

namespace synpo {
namespace {

struct Range {
  uint32_t first, last;
};

bool within(std::span<const Range> ranges, uint32_t code) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const Range& range) { return code >= range.first && code <= range.last; });
}

// Whether a character shows as a blank or as nothing at all.
bool is_blank(uint32_t code) {
  static constexpr Range blank[] = {
      {0x20, 0x20},     {0xa0, 0xa0},     {0xad, 0xad},     {0x115f, 0x1160}, {0x1680, 0x1680},  {0x180b, 0x180e},
      {0x2000, 0x200f}, {0x2028, 0x202f}, {0x205f, 0x206f}, {0x2800, 0x2800}, {0x3000, 0x3000},  {0x3164, 0x3164},
      {0xfe00, 0xfe0f}, {0xfeff, 0xfeff}, {0xffa0, 0xffa0}, {0xfff9, 0xfffb}, {0xe0000, 0xe0fff}};
  return within(blank, code);
}

// Whether a character has ink of its own: neither blank nor a mark on what is before it.
bool is_seen_alone(uint32_t code) {
  static constexpr Range marks[] = {{0x300, 0x36f},   {0x483, 0x489},   {0x1ab0, 0x1aff},
                                    {0x1dc0, 0x1dff}, {0x20d0, 0x20ff}, {0xfe20, 0xfe2f}};
  return !within(marks, code) && (code == ' ' || !is_blank(code));
}

// As printable(), and without blanks other than ' ' where these are `told_apart`; cut where `out` has come to `limit`
// bytes. Whether all of the text is in it.
bool add_printable(std::string_view text, size_t limit, bool told_apart, std::string& out) {
  static const char digits[] = "0123456789abcdef";
  size_t i = 0;
  while (i < text.size() && out.size() < limit) {
    const Character c = character_at(text, i);
    if (printable_length(text, i) > 0 && !(told_apart && c.code != ' ' && is_blank(c.code))) {
      out.append(text, i, c.length);
      i += c.length;
      continue;
    }
    for (const size_t end = i + std::max<size_t>(1, c.length); i < end; ++i) {
      const uint8_t byte = uint8_t(text[i]);
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
  if (!add_printable(text, limit, false, out)) out += "...";
  return out;
}

std::string quoted(const std::string& text) {
  constexpr size_t kLimit = 60;
  std::string out = "'";
  return add_printable(text, kLimit, true, out) ? out + "'" : out + "...'";
}

std::string character_text(std::string_view text, size_t at) {
  const auto [length, code] = character_at(text, at);
  if (length == 0) return "the byte " + printable(text.substr(at, 1));
  const std::string_view character = text.substr(at, length);
  if (character == "\t") return "a tab";
  if (character == "\r") return "a carriage return";
  if (character == "\xc2\xa0") return "a no-break space";
  if (character == "\xef\xbb\xbf") return "a byte order mark";
  if (printable_length(text, at) > 0 && is_seen_alone(code)) return concat('\'', character, '\'');
  std::ostringstream out;
  out << "U+" << std::hex << std::uppercase << std::setw(4) << std::setfill('0') << code;
  return out.str();
}

}  // namespace synpo
