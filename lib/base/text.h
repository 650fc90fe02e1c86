// Text: UTF-8, where it is well formed; numbers, so that they come back as they were; lists for a sentence.
#pragma once
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace synpo {

// Bytes of the character at `at`; 0 where no well-formed one begins (no overlong form, no surrogate, at most
// U+10FFFF).
size_t utf8_length(std::string_view text, size_t at);

// The character at `at`; of no bytes where no well-formed one begins.
struct Character {
  size_t length = 0;  // bytes
  uint32_t code = 0;  // Unicode's number of it
};
Character character_at(std::string_view text, size_t at);

// Columns that a terminal gives to a character: 2 for those of East Asian scripts and for small pictures, 0 for a mark
// that stands on the character before it, 1 for others.
int columns_of(uint32_t code);
// The same of UTF-8 text.
size_t columns_of(std::string_view text);

// Whether a terminal acts on this character where it should show it: C0 and C1 control characters and DEL.
bool is_control(uint32_t code);

// Bytes of the character at `at` where it can go to a terminal as it is; 0 where no well-formed one begins, for control
// characters (tabs and line ends too), and for marks that turn the direction of what follows.
size_t printable_length(std::string_view text, size_t at);

// Where the first byte stands that is not part of valid UTF-8 or that is a control character other than a tab; npos
// when there is no such byte.
size_t first_bad_byte(std::string_view text);

// What keeps `name` from standing wherever environments, tasks and methods are named, which is 1 to kLongestName bytes
// of UTF-8 without control characters: "found ..., expected ..."; empty when nothing does.
constexpr size_t kLongestName = 255;
std::string fault_of_name(std::string_view name);

// True when `a` comes before `b` with runs of digits compared as numbers: map2 before map10.
bool natural_less(const std::string& a, const std::string& b);

// The shortest decimal that reads back to the same bits.
std::string shortest(double value);

// Rounded to whole per cent; 0 and 100 only where none and all are meant.
int64_t whole_percent(double percent, bool some, bool not_all);
// A share in whole per cent, "83 %"; 0 % and 100 % only where it is just that, and "-" for NaN.
std::string percent_text(double share);

// ".png" of the file's name "a.PNG"; "" of one that has none.
std::string extension_of(const std::string& path);

// "a, b or c", as a sentence names choices; "" for an empty list.
std::string alternatives(const std::vector<std::string>& words);

// "1 step", "2 steps".
std::string counted(int64_t n, std::string_view noun);

// " (did you mean 'count'?)", with those of the names that `word` may be a slip of the pen for: letters that are wrong,
// missing, too many or swapped with their neighbours, one for every three letters of the word; or its end is missing.
// Digits are never a slip. "" where there is no such name, or where more than three are as near as one another.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

#ifndef __cpp_lib_to_chars
// As parse_whole.
bool parse_real(std::string_view text, double& value);
#endif

// Reads the whole text as a number; false, and `value` is anything, where it is not a number or does not fit.
template <class Number>
bool parse_whole(std::string_view text, Number& value) {
#ifndef __cpp_lib_to_chars  // libc++'s from_chars knows integers only
  if constexpr (std::is_floating_point_v<Number>)
    return parse_real(text, value);
  else
#endif
  {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }
}

}  // namespace synpo
