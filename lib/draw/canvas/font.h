// Text for pictures: one TrueType font, found on the system or named by the user.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace synpo {

// A line of text as coverage, 0 to 255, cropped to its ink across and measured from the baseline up and down.
struct TextMask {
  int width = 0, ascent = 0, descent = 0;  // ascent + descent rows
  std::vector<uint8_t> coverage;           // [ascent + descent, width]
};

constexpr Cause kNoFont{"no font is installed"};

class Font {
 public:
  // `path` empty: $SYNPO_FONT, else DejaVu Sans where the distributions put it. Throws kNoInput when there is none
  // (kNoFont where no file is named), kData when the file is no font.
  explicit Font(const std::string& path = "");
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  // `size` is the height of the em square in pixels. The mask lives as long as the font.
  const TextMask& mask(const std::string& text, int size) const;
  int width(const std::string& text, int size) const { return mask(text, size).width; }
  // Height of a digit: what to centre on in a cell.
  int digit_height(int size) const { return mask("0", size).ascent; }
  // `text`, or its beginning and end with an ellipsis between them, so that it is at most `width` pixels wide.
  std::string fitted(const std::string& text, int size, int width) const;
  // `text` broken at line ends, and at blanks into lines of at most `width` pixels; a longer word is fitted.
  std::vector<std::string> wrapped(const std::string& text, int size, int width) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
  mutable std::map<std::pair<std::string, int>, TextMask> masks_;
};

}  // namespace synpo
