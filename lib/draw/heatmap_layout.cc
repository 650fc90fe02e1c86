#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "draw/heatmap.h"
#include "draw/heatmap_legend.h"

namespace synpo {
namespace {

constexpr double kLabelPt = 8.5, kSmallestLabelPt = 5.5, kLongestLabelPt = 150;
constexpr double kValuePt = 9, kSmallestValuePt = 5.5;
constexpr int kSmallestValuePixels = 7;
constexpr double kNarrowestPt = 230;

double automatic_cell_pt(size_t longer_side) {
  if (longer_side <= 6) return 34;
  if (longer_side <= 24) return 26;
  if (longer_side <= 60) return 21;
  return std::max(3.0, 1260.0 / double(longer_side));
}

// Every label that has room at `size`, the first always; cut to `longest`.
std::vector<std::string> labels(const std::vector<std::string>& names, int cell, int size, int longest, const Font& font) {
  const size_t step = size_t(std::max(1.0, std::ceil(1.15 * size / cell)));
  std::vector<std::string> out(names.size());
  for (size_t i = 0; i < names.size(); i += step) out[i] = font.fitted(names[i], size, longest);
  return out;
}

int widest(const std::vector<std::string>& texts, int size, const Font& font) {
  int width = 0;
  for (const std::string& text : texts) width = std::max(width, font.width(text, size));
  return width;
}

}  // namespace

int HeatmapLayout::pixels(double pt) const { return std::max(1, int(std::lround(pt * scale))); }

HeatmapLayout lay_out_heatmap(const HeatTable& table, const HeatmapStyle& style, const Font& font) {
  HeatmapLayout out{};
  out.scale = style.scale;
  const auto px = [&](double pt) { return out.pixels(pt); };
  const size_t tasks = table.tasks.size(), envs = table.envs.size();
  // Canvas refuses sizes far below this; the bound keeps the sums below from overflowing.
  if (std::max(tasks, envs) > 100'000) fail(Exit::kUsage, "a side of ", std::max(tasks, envs), " cells cannot be drawn");
  out.cell = px(style.cell_pt > 0 ? style.cell_pt : automatic_cell_pt(std::max(tasks, envs)));
  out.gap = out.cell >= px(8) ? px(0.75) : 0;
  out.label_size = std::clamp(out.cell * 5 / 6, px(kSmallestLabelPt), px(kLabelPt));
  if (style.values) {
    out.value_size = px(kValuePt);
    while (out.value_size > 0 && font.width("0.88", out.value_size) > out.cell - out.gap - px(3)) --out.value_size;
    if (out.value_size < std::max(kSmallestValuePixels, px(kSmallestValuePt))) out.value_size = 0;
  }

  out.margin = px(10);
  out.title_size = px(12);
  out.title_line = px(17);
  out.caption_size = px(9);
  out.caption_line = px(13);
  out.axis_size = px(9);
  const int space = px(5), axis = out.axis_size + px(7), longest = px(kLongestLabelPt);
  out.task_labels = labels(table.tasks, out.cell, out.label_size, longest, font);
  out.env_labels = labels(table.envs, out.cell, out.label_size, longest, font);
  const int env_width = widest(out.env_labels, out.label_size, font);
  out.env_labels_up = env_width > out.cell - px(3);
  out.bar_height = std::clamp(int(tasks) * out.cell, px(90), px(190));
  const HeatmapLegend legend = lay_out_legend(table, out, font);

  // Each axis' name is centred on the matrix and may be longer than it.
  const int env_axis = font.width(kEnvAxis, out.axis_size), task_axis = font.width(kTaskAxis, out.axis_size);
  Box& matrix = out.matrix;
  matrix.width = int(envs) * out.cell;
  matrix.height = int(tasks) * out.cell;
  matrix.x = out.margin + std::max(axis + widest(out.task_labels, out.label_size, font) + space, (env_axis - matrix.width + 1) / 2);
  const int matrix_right = std::max(matrix.right(), matrix.x + (matrix.width + env_axis + 1) / 2);
  out.legend.x = matrix_right + px(22);
  out.legend.width = legend.width;
  out.legend.height = legend.height;
  out.width = std::max(out.legend.right() + out.margin, px(kNarrowestPt));

  out.title = font.wrapped(style.title, out.title_size, out.width - 2 * out.margin);
  out.caption = font.wrapped(table.caption, out.caption_size, out.width - 2 * out.margin);
  matrix.y = out.margin + int(out.title.size()) * out.title_line + int(out.caption.size()) * out.caption_line;
  if (matrix.y > out.margin) matrix.y += px(5);
  matrix.y += std::max(0, (task_axis - matrix.height + 1) / 2);
  out.legend.y = matrix.y;
  out.env_axis_y = matrix.bottom() + space + (out.env_labels_up ? env_width : out.label_size) + px(6);
  // The names' letters reach below the digits' line by up to a third of their size.
  out.height = std::max({out.env_axis_y + out.axis_size * 4 / 3, out.legend.bottom(), matrix.y + (matrix.height + task_axis + 1) / 2}) + out.margin;
  return out;
}

}  // namespace synpo
