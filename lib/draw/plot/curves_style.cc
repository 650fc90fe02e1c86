#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>

#include "draw/plot/curves.h"

namespace synpo {
namespace {

double number(const std::string& text, const char* expected) {
  size_t end = 0;
  double value = NAN;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
  }
  if (!(std::abs(value) <= 1e15) || end != text.size() || std::isspace(uint8_t(text[0])))
    throw std::invalid_argument(expected);
  return value;
}

}  // namespace

AxisRange parse_axis_range(const std::string& text) {
  constexpr char kExpected[] = "expected LOW:HIGH, such as 0:100, 20: or :1e6";
  const size_t colon = text.find(':');
  if (colon == std::string::npos) throw std::invalid_argument(kExpected);
  AxisRange range;
  if (colon > 0) range.low = number(text.substr(0, colon), kExpected);
  if (colon + 1 < text.size()) range.high = number(text.substr(colon + 1), kExpected);
  if (range.high - range.low <= 1e-9 * std::max(std::abs(range.low), std::abs(range.high)))
    throw std::invalid_argument("expected LOW below HIGH");
  return range;
}

CurveMark parse_curve_mark(const std::string& text) {
  CurveMark mark;
  const size_t equals = std::min(text.find('='), text.size()), colon = text.find(':');
  if (equals < text.size()) mark.label = text.substr(equals + 1);
  const size_t begin = colon < equals ? colon + 1 : 0;
  if (begin > 0) mark.part = text.substr(0, colon);
  constexpr char kExpected[] = "expected VALUE=LABEL, seen:VALUE=LABEL or unseen:VALUE=LABEL";
  if (begin > 0 && mark.part != "seen" && mark.part != "unseen") throw std::invalid_argument(kExpected);
  mark.value = number(text.substr(begin, equals - begin), kExpected);
  return mark;
}

void parse_curves_size(const std::string& text, CurvesStyle& style) {
  constexpr char kExpected[] = "expected WIDTHxHEIGHT in points, such as 380x270, each from 20 to 10000";
  const size_t cross = text.find('x');
  if (cross == std::string::npos) throw std::invalid_argument(kExpected);
  style.width_pt = number(text.substr(0, cross), kExpected);
  style.height_pt = number(text.substr(cross + 1), kExpected);
  if (std::min(style.width_pt, style.height_pt) < 20 || std::max(style.width_pt, style.height_pt) > 10000)
    throw std::invalid_argument(kExpected);
}

}  // namespace synpo
