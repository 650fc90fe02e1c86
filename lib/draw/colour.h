// Colours of the pictures: ramps on which darker means better, and inks that can be read on them.
#pragma once
#include <string>

#include "world/view.h"

namespace synpo {

// A hue in the OKLCh space. ramp_colour() runs from a light tint at 0 to a dark shade at 1 with the same lightness for every
// hue, so that cells of two hues can be compared, and a print in grey still shows the rate.
struct Ramp {
  double hue_degrees;
  double chroma;  // at most; less where sRGB cannot show it
};

// `rate` in [0, 1]; lightness falls strictly with it.
Rgb ramp_colour(const Ramp& ramp, double rate);

struct Scheme {
  const char* name;
  Ramp seen, unseen, other;  // `other` is for a third kind of cells: the pairs of part P
};

// "safe" (blue and orange: told apart by colour-blind readers), "purple-red" (Figures 6 and 8), "blue-red" (Figures 4 and 5).
// Throws std::invalid_argument for any other name.
const Scheme& find_scheme(const std::string& name);

// Black or white, whichever stands out more.
Rgb ink_on(Rgb ground);
// Relative luminance (WCAG 2), 0 to 1.
double luminance(Rgb colour);

constexpr Rgb kInk = {33, 37, 41};        // text
constexpr Rgb kSoftInk = {95, 101, 108};  // captions, axis titles
constexpr Rgb kHairline = {205, 209, 214};
constexpr Rgb kPaper = {255, 255, 255};

}  // namespace synpo
