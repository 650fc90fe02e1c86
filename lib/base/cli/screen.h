// The terminal that words go to: how much room it has, and text that fits.
#pragma once
#include <cstddef>
#include <string>

namespace synpo {

struct ScreenSize {
  int columns = 0, rows = 0;  // 0: not known
};

// The size of the terminal of a descriptor, as it is at this moment; where the terminal does not tell it, that of
// the variables COLUMNS and LINES. Of what is no terminal nothing is known.
ScreenSize screen_size(int fd);

// Words of `text` in lines of at most `width` columns where words allow: `used` columns of the first line are taken,
// and all others are indented. Lines of the text stay apart. What stands in square brackets and an option's dash stay
// with what is before them, so that no line but the first begins with a dash.
std::string wrapped(const std::string& text, size_t used, size_t indent, size_t width);

// The word as a shell reads it back: in quotes where it holds more than letters, digits and harmless marks.
std::string shell_quoted(const std::string& word);

}  // namespace synpo
