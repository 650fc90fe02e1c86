// Where a plan of square cells is drawn.
#pragma once
#include "draw/canvas/canvas.h"

namespace synpo {

// Its top left corner, pixels a cell, and cells a row; cells are numbered row by row.
struct PlanGrid {
  int x, y, cell, columns;
  Box box(int at) const { return {x + at % columns * cell, y + at / columns * cell, cell, cell}; }
  Point centre(int at) const { return {x + (at % columns + 0.5) * cell, y + (at / columns + 0.5) * cell}; }
};

}  // namespace synpo
