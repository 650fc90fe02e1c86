// Success matrices as pictures: tasks down, environments across, one colour ramp for each kind of pair (Figures 4 to 6 and 8).
//
// In three steps, each of which can be looked at alone: pool_matrix() sums the counts, lay_out_heatmap() decides sizes and
// labels, draw_heatmap() draws.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "draw/canvas.h"
#include "draw/colour.h"
#include "format/matrix.h"

namespace synpo {

struct HeatCell {
  int64_t episodes = 0, successes = 0;  // summed over the runs; no episodes: drawn as empty
  int group = -1;                       // index into HeatTable::groups; -1 where the matrix has no such pair
  int part = -1;                        // index into HeatTable::parts
  bool evaluated() const { return episodes > 0; }
  double rate() const { return double(successes) / double(episodes); }
};

// A kind of pairs with a mean of its own: seen and unseen, or a part.
struct HeatGroup {
  std::string name;
  int64_t pairs = 0, episodes = 0, successes = 0;  // of the pairs evaluated
  double rate() const { return double(successes) / double(episodes); }
};

struct HeatTable {
  std::vector<std::string> envs, tasks;
  std::vector<HeatCell> cells;    // [tasks, envs]
  std::vector<HeatGroup> groups;  // what the colours tell apart, only what occurs
  std::vector<HeatGroup> parts;   // empty where the matrix has none
  bool by_part = false;           // groups are the parts
  std::string caption;            // method, runs and episodes, in words
  const HeatCell& at(size_t task, size_t env) const { return cells[task * envs.size() + env]; }
};

// Sums the rows of each pair over runs and shards. Environments come in natural order, tasks in the order of Figure 6 where all
// are tasks of GridWorld, else as they appear first. `method` empty: all rows. Throws kData when the rows left are of several
// methods or worlds, when a pair is seen in one row and unseen in another (or in two parts), when no row is left, and for `by_part` without parts.
HeatTable pool_matrix(const Matrix& matrix, const std::string& method = "", bool by_part = false);

struct HeatmapStyle {
  std::string scheme = "safe";
  std::string title;
  bool values = true;   // rates in the cells, where they can be read
  double scale = 2;     // pixels per point
  double cell_pt = 0;   // 0: by the size of the matrix
};

constexpr char kTaskAxis[] = "task", kEnvAxis[] = "environment";

// All in pixels.
struct HeatmapLayout {
  double scale;
  int width, height, margin;
  int title_size, title_line, caption_size, caption_line, axis_size;  // heights of text, and from line to line
  std::vector<std::string> title, caption;                            // lines
  int cell, gap;                   // distance from cell to cell, and the white line in it
  Box matrix;
  int label_size, value_size;      // value_size 0: no values
  bool env_labels_up;              // environments' names read upwards
  std::vector<std::string> env_labels, task_labels;  // cut where they are too long, empty where there is no room for each
  int env_axis_y;                  // top of the axis' name
  Box legend;
  int bar_height;
  int pixels(double pt) const;     // at least 1
};

HeatmapLayout lay_out_heatmap(const HeatTable& table, const HeatmapStyle& style, const Font& font);
Canvas draw_heatmap(const HeatTable& table, const HeatmapStyle& style, const Font& font);

// The ramp of a group of the table.
const Ramp& group_ramp(const HeatTable& table, int group, const Scheme& scheme);
// "0.83"; 1.00 and 0.00 only where all or none succeeded.
std::string rate_text(int64_t successes, int64_t episodes);

}  // namespace synpo
