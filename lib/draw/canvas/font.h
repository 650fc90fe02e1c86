// Text for pictures: one TrueType font, found on the system or named by the user.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/shortened.h"

struct FT_FaceRec_;

namespace synpo {

// Where a line of text has its glyphs and its ink, in heights of the em square; y upwards, from where the pen begins.
struct TextShape {
  struct Glyph {
    uint32_t index;  // in the font
    double x, y;     // of its origin
    uint32_t begin;  // the byte of the text where its cluster begins
  };
  std::vector<Glyph> glyphs;                        // from left to right
  bool leftwards = false;                           // the text is read from right to left
  double advance = 0;                               // to where the pen ends
  double left = 0, right = 0, top = 0, bottom = 0;  // of the ink; all 0 where there is none
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

  // It lives as long as the font.
  const TextShape& shape(const std::string& text) const;
  // Of the ink, in pixels. `size` is the height of the em square in pixels.
  int width(const std::string& text, int size) const;
  // Height of a digit: what to centre on in a cell.
  int digit_height(int size) const;
  // Names in at most `width` pixels: see draw/shortened.h.
  std::string fitted(const std::string& text, int size, int width) const;
  std::vector<std::string> fitted_apart(const std::vector<std::string>& names, int size, int width) const;
  // `text` broken at line ends, and at blanks into lines of at most `width` pixels; a longer word is fitted.
  std::vector<std::string> wrapped(const std::string& text, int size, int width) const;

  // Of the font: "DejaVu Sans".
  std::string family() const;
  // The characters of all texts so far that the font has no glyphs for, each once.
  const std::set<std::string>& missing() const { return missing_; }
  // Whether a text so far had letters of both directions of writing: it is set in that of its first letter.
  bool mixes_directions() const { return mixes_directions_; }
  // FreeType's, for what draws with it.
  std::shared_ptr<FT_FaceRec_> face() const;

 private:
  Ruler ruler(int size) const;
  struct Face;
  std::shared_ptr<Face> face_;
  mutable std::map<std::string, TextShape> shapes_;
  mutable std::set<std::string> missing_;
  mutable bool mixes_directions_ = false;
};

}  // namespace synpo
