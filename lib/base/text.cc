#include "base/text.h"

#include <locale.h>
#include <stdlib.h>
#include <wchar.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {

constexpr size_t kFar = 1000;

// Letters that were mistaken, missing, too many, or swapped with their neighbours: the optimal string alignment
// distance, where a digit is never mistaken and a letter is the same in upper case.
size_t slips_between(std::string_view a, std::string_view b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto same = [](char x, char y) { return std::tolower(uint8_t(x)) == std::tolower(uint8_t(y)); };
  const auto cost = [&](char c) { return digit(c) ? kFar : size_t{1}; };
  const auto wrong = [&](char x, char y) { return same(x, y) ? 0 : std::max(cost(x), cost(y)); };
  std::vector<size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (size_t j = 1; j <= b.size(); ++j) above[j] = above[j - 1] + cost(b[j - 1]);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = above[0] + cost(a[i - 1]);
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({above[j] + cost(a[i - 1]), row[j - 1] + cost(b[j - 1]), above[j - 1] + wrong(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + std::max(cost(a[i - 1]), cost(a[i - 2])));
    }
    before = above;
    std::swap(above, row);
  }
  return above[b.size()];
}

}  // namespace

size_t utf8_length(std::string_view text, size_t at) {
  const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t{0}; };
  const uint8_t lead = byte(at);
  if (lead < 0x80) return at < text.size() ? 1 : 0;
  const size_t length = lead >= 0xc2 && lead <= 0xdf   ? 2
                        : (lead & 0xf0) == 0xe0        ? 3
                        : lead >= 0xf0 && lead <= 0xf4 ? 4
                                                       : 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(at + i) & 0xc0) != 0x80) return 0;
  const uint8_t second = byte(at + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool surrogate = lead == 0xed && second > 0x9f, too_high = lead == 0xf4 && second > 0x8f;
  return overlong || surrogate || too_high ? 0 : length;
}

Character character_at(std::string_view text, size_t at) {
  const size_t length = utf8_length(text, at);
  if (length == 0) return {};
  uint32_t code = uint8_t(text[at]) & (length == 1 ? 0x7f : 0x7f >> length);
  for (const char next : text.substr(at + 1, length - 1)) code = code << 6 | (uint8_t(next) & 0x3f);
  return {length, code};
}

int columns_of(uint32_t code) {
  constexpr uint32_t kFirstMark = 0x300;
  if (code < kFirstMark) return 1;
  static const locale_t unicode = newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
  if (!unicode) return 1;
  const locale_t before = uselocale(unicode);
  const int columns = wcwidth(wchar_t(code));
  uselocale(before);
  return columns < 0 ? 1 : columns;
}

size_t columns_of(std::string_view text) {
  size_t columns = 0;
  for (size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    columns += length > 0 ? size_t(columns_of(code)) : 1;
    i += std::max<size_t>(length, 1);
  }
  return columns;
}

bool is_control(uint32_t code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

size_t printable_length(std::string_view text, size_t at) {
  const auto [length, code] = character_at(text, at);
  const bool direction = code == 0x61c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                         (code >= 0x2066 && code <= 0x2069);
  return is_control(code) || direction ? 0 : length;
}

size_t first_bad_byte(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto [length, code] = character_at(text, i);
    if (length == 0 || (is_control(code) && code != '\t')) return i;
    i += length;
  }
  return std::string_view::npos;
}

std::string fault_of_name(std::string_view name) {
  if (name.empty()) return "found an empty name, expected one of 1 to " + std::to_string(kLongestName) + " bytes";
  if (name.size() > kLongestName)
    return "found a name of " + std::to_string(name.size()) + " bytes, expected at most " +
           std::to_string(kLongestName);
  const size_t at = std::min(first_bad_byte(name), name.find('\t'));
  if (at == std::string_view::npos) return "";
  const size_t length = utf8_length(name, at);
  std::string bytes;
  for (const char c : name.substr(at, std::max<size_t>(1, length))) {
    char byte[8];
    std::snprintf(byte, sizeof byte, "\\x%02x", uint8_t(c));
    bytes += byte;
  }
  return std::string("found ") + (length > 0 ? "a control character" : "invalid UTF-8") + " at byte " +
         std::to_string(at + 1) + " of the name (" + bytes + "), expected UTF-8 text";
}

bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const size_t i0 = std::min(a.find_first_not_of('0', i), a.size()),
                   j0 = std::min(b.find_first_not_of('0', j), b.size());
      size_t i1 = i0, j1 = j0;
      while (i1 < a.size() && digit(a[i1])) ++i1;
      while (j1 < b.size() && digit(b[j1])) ++j1;
      if (i1 - i0 != j1 - j0) return i1 - i0 < j1 - j0;
      if (const int order = a.compare(i0, i1 - i0, b, j0, j1 - j0)) return order < 0;
      i = i1;
      j = j1;
    } else {
      if (a[i] != b[j]) return uint8_t(a[i]) < uint8_t(b[j]);
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

std::string shortest(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

int64_t whole_percent(double percent, bool some, bool not_all) {
  int64_t whole = std::llround(percent);
  if (some) whole = std::max<int64_t>(whole, 1);
  if (not_all) whole = std::min<int64_t>(whole, 99);
  return whole;
}

std::string percent_text(double share) {
  return std::isnan(share) ? "-" : concat(whole_percent(100 * share, share > 0, share < 1), " %");
}

#ifndef __cpp_lib_to_chars
bool parse_real(std::string_view text, double& value) {
  // strtod would take blanks, a plus and hexadecimal digits, too.
  if (text.empty() || text.find_first_not_of("0123456789.eE+-infatyINFATY") != text.npos || text[0] == '+')
    return false;
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string whole(text);
  char* end;
  errno = 0;
  value = strtod_l(whole.c_str(), &end, plain);
  const bool fits = errno != ERANGE || (value != 0 && std::isfinite(value));
  return fits && end == whole.c_str() + whole.size();
}
#endif

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return char(std::tolower(uint8_t(c))); });
  return extension;
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string list;
  for (size_t i = 0; i < words.size(); ++i) list += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  return list;
}

std::string counted(int64_t n, std::string_view noun) { return concat(n, " ", noun, n == 1 ? "" : "s"); }

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
  constexpr size_t kLongest = 100, kMostNames = 10'000, kMostNamed = 3;
  size_t least = kFar;
  std::vector<std::string> nearest;
  if (word.size() > kLongest || names.size() > kMostNames) return "";
  for (const std::string& name : names) {
    if (name.size() > kLongest) continue;
    const bool cut = word.size() > 1 && name.starts_with(word);
    const size_t slips = cut ? 1 : slips_between(word, name);
    if (3 * slips > std::max(word.size(), name.size()) || slips > least) continue;
    if (slips < least) nearest.clear();
    least = slips;
    nearest.push_back(quoted(name));
  }
  if (nearest.empty() || nearest.size() > kMostNamed) return "";
  return " (did you mean " + alternatives(nearest) + "?)";
}

}  // namespace synpo
