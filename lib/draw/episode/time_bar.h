// The steps of an episode by their colour, downwards, with signs at some of them.
#pragma once
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"

namespace synpo {

struct TimeMark {
  int step;  // from 1; marks come by rising steps
  Sign sign;
};

// With its numbers, for up to 300 steps, and the space before it.
int time_bar_width(const Font& font, const Pixels& px);
// In a column of that width beside a plan.
void draw_time_bar(Canvas& canvas, int x, int y, int height, int steps, const std::vector<TimeMark>& marks,
                   const Pixels& px);

}  // namespace synpo
