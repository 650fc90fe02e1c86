// Curves on a terminal: dots of braille where its characters are UTF-8, else a mark of its own for each line.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "draw/terminal/terminal.h"

namespace synpo {

struct TextCurve {
  std::string name;          // may be empty where there is but one
  std::vector<double> x, y;  // x rises
};

struct TextCurvesStyle {
  static constexpr double kByData = std::numeric_limits<double>::quiet_NaN();
  std::string note, title, x_title, y_title;  // the note stands above all
  bool percent = false;                       // y runs from 0 to 100 where no range is given
  // Ends of the axes.
  double x_low = kByData, x_high = kByData, y_low = kByData, y_high = kByData;
  int columns = 80, rows = 24;  // of all of it
  bool braille = false;
  TerminalColour colour = TerminalColour::kNone;
};

// Lines of at most `columns` columns, `rows` in all where that is enough for a plot of a few rows: title, plot with
// axes, and a legend with the last value of each curve. Curves that have no point are in the legend alone.
// Without colours each of several braille curves bears a mark of its own in some places.
std::string text_curves(const std::vector<TextCurve>& curves, const TextCurvesStyle& style);

// Whether LC_ALL, LC_CTYPE or LANG, the first that is set, says that characters are UTF-8.
bool locale_is_utf8();

}  // namespace synpo
