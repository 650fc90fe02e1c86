// Names that must fit a width, whatever it is measured in: the pixels of a font, the columns of a terminal.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace synpo {

// Positions at which a new character of UTF-8 text begins, with the marks that stand on it, and the text's end.
std::vector<size_t> character_starts(const std::string& text);

struct Ruler {
  std::function<int(const std::string&)> width_of;
  std::string ellipsis = "\u2026";
  int gap = 0;  // before a number that tells two names apart
};

// Of a terminal's columns. The ellipsis is one that every terminal has, or the caller's.
Ruler by_columns(std::string ellipsis = "..");

// `text`, or its beginning and end with an ellipsis between them, so that it is at most `width` wide.
std::string fitted(const std::string& text, const Ruler& ruler, int width);

// Each of the names fitted, so that different ones stay different: where both ends are alike, by what lies between, or
// by a number.
std::vector<std::string> fitted_apart(const std::vector<std::string>& names, const Ruler& ruler, int width);

}  // namespace synpo
