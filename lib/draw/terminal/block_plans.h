// Plans of environments on a terminal, as blocks of two columns a cell, coloured where it has colours.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "draw/map_style.h"
#include "draw/terminal/terminal.h"

namespace synpo {

// A cell: twice `mark` on a block of its colour, or twice `plain` where there is no colour.
struct Block {
  Rgb ground;
  char mark, plain;
};

struct BlockPlan {
  std::string name;
  int rows, columns;
  std::function<Block(int row, int column)> block;
};

// The plans with their names, shortened so that they stay different where they are wider than a plan. A row has as many
// as `width` columns hold (0: 80), at most `style.columns` where that is not 0.
std::string terminal_plans(const std::vector<BlockPlan>& plans, const MapStyle& style, TerminalColour colour,
                           int width);

}  // namespace synpo
