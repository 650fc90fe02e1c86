#include "draw/canvas/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace synpo {
namespace {

// Ends that miss a tick by rounding alone still have it.
constexpr double kSlack = 1e-9;

// Multiples of the step from the first to the last that lie inside.
double first_multiple(double low, double step) { return std::ceil(low / step - kSlack); }
double last_multiple(double high, double step) { return std::floor(high / step + kSlack); }

// 1, 2 or 5 times a power of ten: the smallest that is not below `least`.
double nice_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - kSlack)) return factor * power;
  return 10 * power;
}

}  // namespace

Ticks nice_ticks(double low, double high, int most) {
  // Beyond this, doubles cannot tell neighbouring ticks apart.
  const double largest = std::max(std::abs(low), std::abs(high));
  if (!(high > low) || largest > 1e100 || high - low < largest * 1e-9 || high - low < 1e-100)
    fail(Exit::kData, "an axis from ", low, " to ", high, " cannot be drawn");
  Ticks ticks;
  // A step of a `most`-th of the range may be one tick too many.
  for (ticks.step = nice_step((high - low) / most);
       last_multiple(high, ticks.step) - first_multiple(low, ticks.step) + 1 > most;)
    ticks.step = nice_step(ticks.step * 1.5);
  for (double k = first_multiple(low, ticks.step); k <= last_multiple(high, ticks.step); ++k)
    ticks.at.push_back(k * ticks.step);
  return ticks;
}

std::string tick_text(double value, double step) {
  char text[64];
  const double size = std::abs(value);
  if (size < step / 2)
    return "0";
  else if (size >= 1e7 || step < 1e-5)
    std::snprintf(text, sizeof text, "%.6g", size);
  else
    std::snprintf(text, sizeof text, "%.*f", std::max(0, int(-std::floor(std::log10(step) + kSlack))), size);
  return value < 0 ? std::string("\u2212") + text : text;
}

Ticks log_ticks(double low, double high, int most) {
  const int first = int(std::floor(std::log10(low) + kSlack)), last = int(std::floor(std::log10(high) + kSlack));
  Ticks ticks{0, {}};
  const auto choose = [&](const std::vector<double>& factors, int every) {
    ticks.at.clear();
    for (int power = first; power <= last; ++power)
      for (const double factor : factors)
        if (const double at = factor * std::pow(10, power);
            power % every == 0 && at >= low * (1 - kSlack) && at <= high * (1 + kSlack))
          ticks.at.push_back(at);
    return int(ticks.at.size()) <= most;
  };
  if (choose({1, 2, 5}, 1)) return ticks;
  for (int every = 1; !choose({1}, every);) ++every;
  return ticks;
}

std::string Axis::label(double value, const Ticks& ticks) const {
  if (!logarithmic) return tick_text(value / unit, ticks.step / unit);
  return tick_text(value / unit, std::pow(10, std::floor(std::log10(value / unit) + kSlack)));
}

double Axis::place(double value) const {
  // Where there is no logarithm, it is far below the axis.
  if (logarithmic) return value > 0 ? std::log(value / low) / std::log(high / low) : -1e3;
  return (value - low) / (high - low);
}

Ticks Axis::ticks(int most) const {
  if (logarithmic) return log_ticks(low, high, most);
  Ticks out = nice_ticks(low / unit, high / unit, most);
  out.step *= unit;
  for (double& at : out.at) at *= unit;
  return out;
}

Axis count_axis(const std::string& title, double low, double high) {
  if (high >= 2e6) return {low, high, 1e6, title + " (millions)"};
  if (high >= 2e4) return {low, high, 1e3, title + " (thousands)"};
  return {low, high, 1, title};
}

Axis value_axis(const std::string& title, double low, double high, int most) {
  if (low > 0 && low < 0.35 * high) low = 0;
  if (low >= high) {
    const double around = std::max(std::abs(low) * 0.1, 1e-3);
    low -= around;
    high += around;
  }
  const double step = nice_ticks(low, high, most).step;
  return {std::floor(low / step + kSlack) * step, std::ceil(high / step - kSlack) * step, 1, title};
}

}  // namespace synpo
