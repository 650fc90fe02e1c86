#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "draw/colour.h"
#include "helpers/heat_tables.h"

namespace synpo {
namespace {

TEST(Colour, DarkerIsBetterAndSeenDiffersFromUnseen) {
  for (const char* name : {"safe", "purple-red", "blue-red", "figure8"}) {
    const Scheme& scheme = find_scheme(name);
    for (const Ramp& ramp : {scheme.seen, scheme.unseen, scheme.other})
      for (int percent = 1; percent <= 100; ++percent)
        EXPECT_LT(luminance(ramp_colour(ramp, percent / 100.0)), luminance(ramp_colour(ramp, (percent - 1) / 100.0)))
            << name << " at " << percent << " %";
    for (int percent = 0; percent <= 100; percent += 5) {
      const Rgb seen = ramp_colour(scheme.seen, percent / 100.0), unseen = ramp_colour(scheme.unseen, percent / 100.0);
      EXPECT_GT(std::abs(seen.r - unseen.r) + std::abs(seen.g - unseen.g) + std::abs(seen.b - unseen.b), 20) << name;
      // The same rate is equally dark in both.
      EXPECT_NEAR(std::cbrt(luminance(seen)), std::cbrt(luminance(unseen)), 0.07) << name << " at " << percent << " %";
    }
  }
  EXPECT_THROW(find_scheme("grey"), std::invalid_argument);
}

TEST(Colour, InkHasAContrastOfAtLeastFourAndAHalf) {
  const Scheme& scheme = find_scheme("safe");
  for (int percent = 0; percent <= 100; ++percent)
    for (const Ramp& ramp : {scheme.seen, scheme.unseen}) {
      const Rgb ground = ramp_colour(ramp, percent / 100.0);
      const double a = luminance(ground) + 0.05, b = luminance(ink_on(ground)) + 0.05;
      EXPECT_GE(std::max(a, b) / std::min(a, b), 4.5);
    }
}

TEST(Colour, PartsHaveTheRampsOfTheirKinds) {
  Matrix matrix;
  matrix.has_part = true;
  matrix.rows = {matrix_row("a", "x", true, 90), matrix_row("b", "x", true, 50), matrix_row("c", "x", false, 30)};
  matrix.rows[0].part = "P";
  matrix.rows[1].part = "Q";
  matrix.rows[2].part = "rest";
  const HeatTable by_part = pool_matrix(matrix, "", true);
  const Scheme& scheme = find_scheme("purple-red");
  EXPECT_EQ(&group_ramp(by_part, by_part.at(0, 1).group, scheme), &scheme.seen);
  EXPECT_EQ(&group_ramp(by_part, by_part.at(0, 2).group, scheme), &scheme.unseen);
}

TEST(Colour, OfTimeDarkens) {
  for (int i = 0; i < 50; ++i) EXPECT_GT(luminance(time_colour(i / 50.0)), luminance(time_colour((i + 1) / 50.0))) << i;
}

}  // namespace
}  // namespace synpo
