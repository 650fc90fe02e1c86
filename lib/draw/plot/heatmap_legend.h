// The legend of a heatmap: a colour bar for each kind of pairs, and a line about each where there is but one panel.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/colour.h"
#include "draw/plot/heatmap.h"
#include "stats/matrix/heat_table.h"

namespace synpo {

struct HeatmapLegend {
  enum class Mark { kRamp, kEmpty, kPart };
  struct Entry {
    Mark mark;
    int index;  // of the group or part
    std::string name, detail;
  };
  std::vector<Entry> entries;
  int width, height;
};

HeatmapLegend lay_out_legend(const HeatFigure& figure, const HeatmapLayout& layout, const Font& font);
void draw_legend(Canvas& canvas, const HeatFigure& figure, const HeatmapLayout& layout, const Scheme& scheme);
// Draws the cell of a pair that was not evaluated.
void draw_empty_cell(Canvas& canvas, const Box& box, int line);

}  // namespace synpo
