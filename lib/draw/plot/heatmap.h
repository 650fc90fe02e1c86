// Success matrices as pictures: tasks down, environments across, one colour ramp for each kind of pair (Figures 4 to 6
// and 8). lay_out_heatmap() decides sizes and labels, draw_heatmap() draws.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/heading.h"
#include "stats/matrix/heat_table.h"

namespace synpo {

struct HeatmapStyle {
  std::string scheme = "safe";
  std::string title;
  bool values = true;    // rates in the cells, where they can be read
  bool margins = false;  // the mean of each task and environment
  double scale = 2;      // pixels per point
  double cell_pt = 0;    // 0: by the size of the matrix
  int64_t columns = 0;   // panels in a row; 0: up to three, more in rows about as long as one another
};

constexpr char kTaskAxis[] = "task", kEnvAxis[] = "environment";
constexpr double kAxisPt = 9;  // their height

// All in pixels.
struct HeatmapLayout {
  struct Panel {
    int heading_y;
    Heading heading;  // where there are several panels
    Box matrix;
    std::vector<HeatMargin> margins;
    bool first, last;                               // of its row
    int env_labels_y, margin_labels_y, env_axis_y;  // tops of the labels and of the axis' name
  };
  double scale;
  int width, height, margin;
  Heading heading;
  int cell, gap;                         // distance from cell to cell, and the white line in it
  int label_size, value_size;            // value_size 0: no values
  bool env_labels_up, margin_labels_up;  // read upwards
  std::vector<std::string> env_labels,
      task_labels;  // cut where they are too long, empty where there is no room for each
  std::vector<Panel> panels;
  int margin_space, margin_cell;  // from the matrix to its margins, and across each
  int tree_space, tree_depth;     // from the cells to a tree, and from its leaves to its root
  Box legend;
  int bar_height;
  int pixels(double pt) const;  // at least 1
  // Ends of what belongs to a panel's rows and columns: the matrix and its margins.
  int right_of(const Panel& panel) const;
  int bottom_of(const Panel& panel) const;
};

HeatmapLayout lay_out_heatmap(const HeatFigure& figure, const HeatmapStyle& style, const Font& font);
Canvas draw_heatmap(const HeatFigure& figure, const HeatmapStyle& style, const Font& font);

}  // namespace synpo
