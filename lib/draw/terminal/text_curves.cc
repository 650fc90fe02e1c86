#include "draw/terminal/text_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "base/rgb.h"
#include "base/text.h"
#include "draw/shortened.h"

namespace synpo {
namespace {

constexpr char kMarks[] = {'*', 'o', '+', 'x', '#', '@', '%'};
// Told apart on light and on dark terminals, and by colour-blind readers.
constexpr Rgb kInks[] = {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}};
constexpr int kLeastPlotRows = 4, kLeastPlotColumns = 10;

std::string inked(const std::string& text, size_t curve, TerminalColour colour) {
  const std::string code = ink_code(kInks[curve % std::size(kInks)], colour);
  return code.empty() ? text : code + text + kPlainCode;
}

char mark_of(size_t curve) { return kMarks[curve % std::size(kMarks)]; }

std::string utf8(uint32_t code) {
  return {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
}

struct Unit {
  double size = 1;
  const char* suffix = "";
  int more_digits = 0;
};

// In which numbers of this size are written.
Unit unit_of(double size) {
  if (size >= 1e6 && size < 1e9) return {1e6, "M"};
  if (size >= 1e4 && size < 1e6) return {1e3, "k", 1};
  return {};
}

std::string number(double value, int digits = 3) {
  const Unit unit = unit_of(std::abs(value));
  char text[32];
  std::snprintf(text, sizeof text, "%.*g%s", digits + unit.more_digits, value / unit.size, unit.suffix);
  return text;
}

struct Range {
  double low, high;
  double share(double value) const { return (value - low) / (high - low); }
};

// The ends that are given, or else those of the values, a little apart where all are alike.
Range range_of(const std::vector<TextCurve>& curves, std::vector<double> TextCurve::*values, double low, double high) {
  Range range = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const TextCurve& curve : curves)
    for (const double value : curve.*values) range = {std::min(range.low, value), std::max(range.high, value)};
  if (!(range.low <= range.high)) range = {0, 1};
  if (!std::isnan(low)) range.low = low;
  if (!std::isnan(high)) range.high = high;
  if (!(range.low < range.high)) range.high = range.low + std::max(1e-9, std::abs(range.low) * 0.01);
  return range;
}

// The ends of the range and what cuts it into `parts`, the highest first, all with as many digits as tell them apart.
std::vector<std::string> tick_labels(const Range& range, int parts) {
  const double size = std::max(std::abs(range.low), std::abs(range.high)),
               step = range.high / parts - range.low / parts;
  const bool as_it_is = size >= 1e-3 && size < 1e9;
  const Unit unit = unit_of(size);
  // To a tenth of a step.
  const double wanted = as_it_is ? 0.7 - std::log10(step / unit.size) : 1.7 + std::log10(size / step);
  const int digits = int(std::clamp(std::ceil(wanted), 0.0, 15.0));
  std::vector<std::string> labels;
  for (int i = 0; i <= parts; ++i) {
    const double value = (range.high * (parts - i) + range.low * i) / parts;
    char text[40];
    std::snprintf(text, sizeof text, as_it_is ? "%.*f" : "%.*g", digits, value / unit.size);
    labels.push_back(text);
  }
  const auto has_zero = [](const std::string& text) {
    return text.find('.') != std::string::npos && text.back() == '0';
  };
  while (as_it_is && std::all_of(labels.begin(), labels.end(), has_zero))
    for (std::string& text : labels) text.erase(text.size() - (text[text.size() - 2] == '.' ? 2 : 1));
  for (std::string& text : labels) {
    if (text.find_first_of("123456789") == std::string::npos)
      text.erase(0, text.find_first_of('0'));
    else
      text += unit.suffix;
  }
  return labels;
}

// A plot of cells with `across` x `down` dots each, the top left one first.
class Dots {
 public:
  Dots(int columns, int rows, bool braille)
      : columns_(columns), rows_(rows), across_(braille ? 2 : 1), down_(braille ? 4 : 1),
        cells_(size_t(columns) * size_t(rows)) {}

  // From and to are shares of the plot's width and height, from its lower left corner.
  void line(size_t curve, double x0, double y0, double x1, double y1) {
    const double width = columns_ * across_ - 1, height = rows_ * down_ - 1;
    const double across = (x1 - x0) * width, up = (y1 - y0) * height;
    const int steps = std::max(1, int(std::min(1e6, std::ceil(std::max(std::abs(across), std::abs(up))))));
    for (int i = 0; i <= steps; ++i) {
      const double share = double(i) / steps, x = x0 + share * (x1 - x0), y = y0 + share * (y1 - y0);
      if (x >= 0 && x <= 1 && y >= 0 && y <= 1)
        dot(curve, int(std::lround(x * width)), int(std::lround((1 - y) * height)));
    }
  }

  // The curve's own mark in every so many columns, where it was drawn last.
  void mark(size_t curve, int first, int every) {
    for (int column = first; column < columns_; column += every)
      for (int row = 0; row < rows_; ++row) {
        Cell& cell = cells_[size_t(row) * size_t(columns_) + size_t(column)];
        if (cell.dots == 0 || cell.curve != curve) continue;
        cell.marked = true;
        break;
      }
  }

  std::string row(int row, TerminalColour colour) const {
    std::string text, blanks;
    for (int column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[size_t(row) * size_t(columns_) + size_t(column)];
      if (cell.dots == 0) {
        blanks += ' ';
        continue;
      }
      const bool braille = across_ == 2 && !cell.marked;
      text +=
          blanks + inked(braille ? utf8(0x2800 + cell.dots) : std::string(1, mark_of(cell.curve)), cell.curve, colour);
      blanks.clear();
    }
    return text;
  }

 private:
  struct Cell {
    uint8_t dots = 0;
    size_t curve = 0;  // the last one that has a dot there
    bool marked = false;
  };
  void dot(size_t curve, int x, int y) {
    constexpr uint8_t kBits[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    Cell& cell = cells_[size_t(y / down_) * size_t(columns_) + size_t(x / across_)];
    cell.dots |= kBits[y % down_][x % across_];
    cell.curve = curve;
  }
  int columns_, rows_, across_, down_;
  std::vector<Cell> cells_;
};

Ruler ruler_of(const TextCurvesStyle& style) { return style.braille ? by_columns("\u2026") : by_columns(); }

std::string cut(const std::string& text, const TextCurvesStyle& style) {
  return fitted(printable(text), ruler_of(style), style.columns);
}

// Whether braille alone would not tell the curves apart.
bool needs_marks(const std::vector<TextCurve>& curves, const TextCurvesStyle& style) {
  return style.braille && style.colour == TerminalColour::kNone && curves.size() > 1;
}

std::string padded(const std::string& text, size_t width) {
  const size_t taken = columns_of(text);
  return taken < width ? std::string(width - taken, ' ') + text : text;
}

// Lines of entries, as many in each as there is room for.
std::vector<std::string> legend(const std::vector<TextCurve>& curves, const TextCurvesStyle& style) {
  constexpr int kLeastName = 6;
  std::vector<std::string> lines, names, values;
  size_t longest = 0, taken = 0;
  for (const TextCurve& curve : curves) {
    names.push_back(printable(curve.name));
    const double last = curve.y.empty() ? NAN : curve.y.back();
    // 100 % is all, and no rounding.
    const double shown = style.percent && last < 100 ? std::min(last, 99.9) : last;
    values.push_back(curve.y.empty() ? "no value" : number(shown) + (style.percent ? " %" : ""));
    longest = std::max(longest, values.back().size());
  }
  names = fitted_apart(names, ruler_of(style), std::max(kLeastName, style.columns - 3 - int(longest)));
  for (size_t i = 0; i < curves.size(); ++i) {
    const std::string mark = style.braille && !needs_marks(curves, style) ? utf8(0x2836) : std::string(1, mark_of(i));
    const std::string words =
        fitted(names[i] + (names[i].empty() ? "" : " ") + values[i], ruler_of(style), style.columns - 2);
    const size_t width = 2 + columns_of(words);
    const bool fits = !lines.empty() && taken + 3 + width <= size_t(style.columns);
    if (fits)
      lines.back() += "   ";
    else
      lines.emplace_back();
    lines.back() += inked(mark, i, style.colour) + " " + words;
    taken = (fits ? taken + 3 : 0) + width;
  }
  return lines;
}

// Low, middle and high across the plot.
std::string x_labels(const Range& range, const std::string& title, int columns) {
  constexpr int kMostDigits = 15;
  std::string low = number(range.low), high = number(range.high);
  for (int digits = 4; low == high && digits <= kMostDigits; ++digits) {
    low = number(range.low, digits);
    high = number(range.high, digits);
  }
  std::string text =
      low + std::string(size_t(columns) - std::min(size_t(columns), low.size() + high.size()), ' ') + high;
  const size_t at = (size_t(columns) - std::min(size_t(columns), title.size())) / 2;
  if (at > low.size() && at + title.size() + high.size() < size_t(columns)) text.replace(at, title.size(), title);
  return text;
}

}  // namespace

bool locale_is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (!value || !*value) continue;
    std::string text = value;
    std::erase(text, '-');
    for (char& c : text) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    return text.find("UTF8") != std::string::npos;
  }
  return false;
}

std::string text_curves(const std::vector<TextCurve>& curves, const TextCurvesStyle& style) {
  const Range x = range_of(curves, &TextCurve::x, style.x_low, style.x_high);
  const bool whole = style.percent;
  const Range y = range_of(curves, &TextCurve::y, whole && std::isnan(style.y_low) ? 0 : style.y_low,
                           whole && std::isnan(style.y_high) ? 100 : style.y_high);
  std::vector<std::string> above;
  for (const std::string& line : {style.note, style.title})
    if (!line.empty()) above.push_back(cut(line, style));
  above.push_back(cut(style.y_title, style));
  const std::vector<std::string> below = legend(curves, style);
  const int rows = std::max(kLeastPlotRows, style.rows - int(above.size() + below.size()) - 2);

  // A label for every fourth part of the axis, or for its ends alone.
  const int parts = rows >= 9 ? 4 : 1;
  const std::vector<std::string> ticks = tick_labels(y, parts);
  std::vector<std::string> labels(size_t(rows), "");
  size_t label = 0;
  for (int i = 0; i <= parts; ++i) {
    labels[size_t(std::lround(double(rows - 1) * i / parts))] = ticks[size_t(i)];
    label = std::max(label, ticks[size_t(i)].size());
  }
  const int columns = std::max(kLeastPlotColumns, style.columns - int(label) - 2);
  Dots dots(columns, rows, style.braille);
  for (size_t i = 0; i < curves.size(); ++i)
    for (size_t at = 0; at < curves[i].x.size(); ++at) {
      const size_t from = at > 0 ? at - 1 : 0;
      dots.line(i, x.share(curves[i].x[from]), y.share(curves[i].y[from]), x.share(curves[i].x[at]),
                y.share(curves[i].y[at]));
    }
  if (needs_marks(curves, style)) {
    const int every = std::max(int(curves.size()), columns / 6);
    for (size_t i = 0; i < curves.size(); ++i) dots.mark(i, int(i * size_t(every) / curves.size()), every);
  }

  const std::string bar = style.braille ? "\u2502" : "|", corner = style.braille ? "\u2514" : "+",
                    dash = style.braille ? "\u2500" : "-";
  std::string text;
  for (const std::string& line : above) text += line + '\n';
  for (int row = 0; row < rows; ++row)
    text += padded(labels[size_t(row)], label) + " " + bar + dots.row(row, style.colour) + '\n';
  text += std::string(label + 1, ' ') + corner;
  for (int column = 0; column < columns; ++column) text += dash;
  text += '\n' + std::string(label + 2, ' ') + x_labels(x, style.x_title, columns) + '\n';
  for (const std::string& line : below) text += line + '\n';
  return text;
}

}  // namespace synpo
