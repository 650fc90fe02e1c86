// Colours of the pictures: ramps on which darker means better, and inks that can be read on them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/rgb.h"
#include "stats/matrix/heat_table.h"

namespace synpo {

// A hue in the OKLCh space. ramp_colour() runs from a light tint at 0 to a dark shade at 1 with the same lightness for
// every hue, so that cells of two hues can be compared, and a print in grey still shows the rate.
struct Ramp {
  double hue_degrees;
  double chroma;  // at most; less where sRGB cannot show it
};

// `rate` in [0, 1]; lightness falls strictly with it.
Rgb ramp_colour(const Ramp& ramp, double rate);

struct Scheme {
  const char* name;
  Ramp seen, unseen, other;  // `other` is for a third kind of cells: new pairs, or those of part P
};

// "safe" (blue and orange: told apart by colour-blind readers), "purple-red" (Figure 6), "blue-red" (Figures 4 and 5),
// "figure8" (part Q in purple, all else in red). Throws std::invalid_argument for any other name.
const Scheme& find_scheme(std::string_view name);
std::vector<std::string> scheme_names();

// The ramp of a group of the table; a grey one for all pairs (-1).
const Ramp& group_ramp(const HeatTable& table, int group, const Scheme& scheme);

// The same for a subset of pairs by its name: seen, unseen or new, a part, or all.
const Ramp& subset_ramp(const std::string& name, const Scheme& scheme);

// The colour that lies `share` of the way from one to the other.
Rgb mix(Rgb from, Rgb to, double share);
// Black or white, whichever stands out more.
Rgb ink_on(Rgb ground);
// Relative luminance (WCAG 2), 0 to 1.
double luminance(Rgb colour);

// From 0, the start, to 1, the last step; darkness rises strictly, hue runs from yellow to purple.
Rgb time_colour(double share);
// Of a step, from 1, of so many.
Rgb step_colour(int step, int steps);

// The rate whose shade stands for a kind of pairs where there are no rates.
constexpr double kSplitShade = 0.65;

constexpr Rgb kInk = {33, 37, 41};        // text
constexpr Rgb kSoftInk = {95, 101, 108};  // captions, axis titles
constexpr Rgb kHairline = {205, 209, 214};
constexpr Rgb kPaper = {255, 255, 255};

}  // namespace synpo
