#include "draw/colour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "base/text.h"

namespace synpo {
namespace {

constexpr double kLightest = 0.955, kDarkest = 0.40;

double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
double to_linear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

struct Linear {
  double r, g, b;
  bool in_gamut() const { return std::min({r, g, b}) >= -1e-6 && std::max({r, g, b}) <= 1 + 1e-6; }
};

// OKLab to linear sRGB (Ottosson 2020).
Linear from_oklch(double lightness, double chroma, double hue_degrees) {
  const double hue = hue_degrees * std::numbers::pi / 180, a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

uint8_t to_byte(double linear) { return uint8_t(std::lround(255 * to_srgb(std::clamp(linear, 0.0, 1.0)))); }

constexpr Scheme kSchemes[] = {
    {"safe", {255, 0.14}, {59, 0.13}, {160, 0.02}},
    {"purple-red", {305, 0.18}, {24, 0.165}, {250, 0.02}},
    {"blue-red", {258, 0.15}, {24, 0.165}, {160, 0.02}},
    {"figure8", {305, 0.18}, {24, 0.165}, {24, 0.165}},
};

}  // namespace

Rgb ramp_colour(const Ramp& ramp, double rate) {
  rate = std::clamp(rate, 0.0, 1.0);
  const double lightness = kLightest + (kDarkest - kLightest) * rate;
  // Already tinted at 0, so that the kinds of cells can be told apart there.
  const double wanted = ramp.chroma * (0.2 + 0.8 * rate * (2 - rate));
  double low = 0, high = 0.4;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (from_oklch(lightness, middle, ramp.hue_degrees).in_gamut() ? low : high) = middle;
  }
  // Short of the gamut's edge, where a channel drops to 0 so steeply that it shows as a step in the ramp.
  const Linear linear = from_oklch(lightness, std::min(wanted, 0.88 * low), ramp.hue_degrees);
  return {to_byte(linear.r), to_byte(linear.g), to_byte(linear.b)};
}

const Scheme& find_scheme(std::string_view name) {
  for (const Scheme& scheme : kSchemes)
    if (name == scheme.name) return scheme;
  throw std::invalid_argument("expected " + alternatives(scheme_names()));
}

std::vector<std::string> scheme_names() {
  std::vector<std::string> names;
  for (const Scheme& scheme : kSchemes) names.emplace_back(scheme.name);
  return names;
}

double luminance(Rgb colour) {
  return 0.2126 * to_linear(colour.r / 255.0) + 0.7152 * to_linear(colour.g / 255.0) +
         0.0722 * to_linear(colour.b / 255.0);
}

Rgb mix(Rgb from, Rgb to, double share) {
  const auto at = [share](uint8_t a, uint8_t b) { return uint8_t(std::lround(a + (b - a) * share)); };
  return {at(from.r, to.r), at(from.g, to.g), at(from.b, to.b)};
}

Rgb ink_on(Rgb ground) {
  // Where the contrast ratios of black and white with the ground, (Y + 0.05) / 0.05 and 1.05 / (Y + 0.05), are equal.
  return luminance(ground) > std::sqrt(1.05 * 0.05) - 0.05 ? Rgb{0, 0, 0} : Rgb{255, 255, 255};
}

const Ramp& subset_ramp(const std::string& name, const Scheme& scheme) {
  static const Ramp grey = {0, 0};
  if (name == "all") return grey;
  if (name == "seen" || name == "Q") return scheme.seen;
  return name == "new" || name == "P" ? scheme.other : scheme.unseen;
}

const Ramp& group_ramp(const HeatTable& table, int group, const Scheme& scheme) {
  return subset_ramp(group < 0 ? "all" : table.groups[group].name, scheme);
}

Rgb time_colour(double share) {
  share = std::clamp(share, 0.0, 1.0);
  return ramp_colour({90 + 215 * share, 0.15}, 0.22 + 0.78 * share);
}

Rgb step_colour(int step, int steps) { return time_colour(steps > 1 ? double(step - 1) / (steps - 1) : 1); }

}  // namespace synpo
