// Ticks of an axis: at 1, 2 or 5 times a power of ten, with labels that have as many digits as the step needs.
#pragma once
#include <string>
#include <vector>

namespace synpo {

struct Ticks {
  double step = 1;
  std::vector<double> at;  // rising
};

// Those within [low, high], low < high, with the smallest step that gives at most `most` of them (2 or more).
// Throws kData for a range that doubles cannot divide.
Ticks nice_ticks(double low, double high, int most);

// Of a logarithmic axis, 0 < low < high: at 1, 2 and 5 times the powers of ten, at the powers alone, or at every
// second, third... of these, so that at most `most` (2 or more) lie in [low, high]; `step` is 0.
Ticks log_ticks(double low, double high, int most);

// "0.05", "12", "1e+09"; a minus sign, not a hyphen, before negative numbers. `value` is a multiple of `step`.
std::string tick_text(double value, double step);

// An axis shows values from `low` to `high`, written in units of `unit` ("1.5" for 1,500,000 in millions). Where it is
// logarithmic both are above 0.
struct Axis {
  double low = 0, high = 1, unit = 1;
  std::string title;  // with the unit
  bool logarithmic = false;
  // Positions, in values, of at most `most` ticks, and their labels.
  Ticks ticks(int most) const;
  std::string label(double value, const Ticks& ticks) const;
  // Share of the way from low to high.
  double place(double value) const;
};

// An axis of counts: thousands or millions where the numbers are long.
Axis count_axis(const std::string& title, double low, double high);
// An axis of any values, its ends moved out to ticks, and down to 0 where that is near.
Axis value_axis(const std::string& title, double low, double high, int most);

}  // namespace synpo
