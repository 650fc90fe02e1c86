// The legend of a plot of curves: entries in rows, above the panels, where no line can run.
#pragma once
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/plot/curves.h"

namespace synpo {

struct CurvesLegend {
  struct Entry {
    std::string name;
    CurveLook look;
    bool band;
    int x, y;  // from the legend's corner, in pixels
  };
  std::vector<Entry> entries;
  int height = 0;
  double band_opacity = 0;
};

// No entries where there is one line without a name. `width` is what a row may take.
CurvesLegend lay_out_curves_legend(const CurveSet& set, bool one_panel, double scale, int width, const Font& font);
void draw_curves_legend(Canvas& canvas, const CurvesLegend& legend, int x, int y, double scale);

}  // namespace synpo
