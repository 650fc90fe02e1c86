#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/heading.h"
#include "draw/plot/dendrogram.h"
#include "draw/plot/heatmap.h"
#include "draw/plot/heatmap_legend.h"
#include "stats/cluster.h"
#include "stats/matrix/heat_table.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

constexpr double kLabelPt = 8.5, kSmallestLabelPt = 5.5, kLongestLabelPt = 150;
constexpr double kValuePt = 9, kSmallestValuePt = 5.5;
constexpr int kSmallestValuePixels = 7;
constexpr double kNarrowestPt = 230, kNarrowestPanelPt = 90, kBetweenPanelsPt = 20;
constexpr double kNarrowestMarginPt = 12, kTreePt = 38;

double automatic_cell_pt(size_t longer_side) {
  if (longer_side <= 6) return 34;
  if (longer_side <= 24) return 26;
  if (longer_side <= 60) return 21;
  return std::max(3.0, 1260.0 / double(longer_side));
}

// Every label that has room at `size`, the first always; cut to `longest`.
std::vector<std::string> labels(const std::vector<std::string>& names, int cell, int size, int longest,
                                const Font& font) {
  const size_t step = size_t(std::max(1.0, std::ceil(1.15 * size / cell)));
  std::vector<std::string> shown, out(names.size());
  for (size_t i = 0; i < names.size(); i += step) shown.push_back(names[i]);
  shown = font.fitted_apart(shown, size, longest);
  for (size_t i = 0; i < shown.size(); ++i) out[i * step] = shown[i];
  return out;
}

int widest(const std::vector<std::string>& texts, int size, const Font& font) {
  int width = 0;
  for (const std::string& text : texts) width = std::max(width, font.width(text, size));
  return width;
}

// The largest size at which a rate fits into a cell, 0 where it could not be read.
int value_size(const HeatmapLayout& layout, const Font& font) {
  int size = layout.pixels(kValuePt);
  while (size > 0 && font.width("0.88", size) > layout.cell - layout.gap - layout.pixels(3)) --size;
  return size < std::max(kSmallestValuePixels, layout.pixels(kSmallestValuePt)) ? 0 : size;
}

std::string caption_of(const HeatFigure& figure) {
  std::string out = figure.panels.size() == 1 ? figure.panels[0].table.caption : "";
  std::string trees;
  const auto add = [&](const std::optional<Dendrogram>& tree, const char* what) {
    if (tree) trees += concat(trees.empty() ? "" : ", ", what, " up to ", decimal(tree->height(), 2), " apart");
  };
  add(figure.task_tree, "tasks");
  add(figure.env_tree, "environments");
  if (!trees.empty()) out += (out.empty() ? "" : "\n") + ("trees: average linkage of success rates, " + trees);
  return out;
}

size_t columns_of(size_t panels, int64_t wished) {
  if (wished > 0) return std::min(panels, size_t(wished));
  // A page is about half as high again as it is wide, and a panel with its labels about as high.
  const size_t rows = std::max<size_t>(1, size_t(std::lround(std::sqrt(double(panels) / 1.5))));
  return (panels + rows - 1) / rows;
}

// Of a panel among several: what the legend says where there is but one.
std::string panel_caption(const HeatTable& table) {
  std::string means;
  for (const HeatGroup& group : table.groups)
    if (group.pairs > 0) means += concat(means.empty() ? "mean " : ", ", group.name, " ", rate_text(group));
  return table.caption + (table.caption.empty() || means.empty() ? "" : "\n") + means;
}

}  // namespace

int HeatmapLayout::pixels(double pt) const { return std::max(1, int(std::lround(pt * scale))); }

int HeatmapLayout::right_of(const Panel& panel) const {
  return panel.matrix.right() + (panel.margins.empty() ? 0 : margin_space + int(panel.margins.size()) * margin_cell);
}

int HeatmapLayout::bottom_of(const Panel& panel) const {
  return right_of(panel) - panel.matrix.right() + panel.matrix.bottom();
}

HeatmapLayout lay_out_heatmap(const HeatFigure& figure, const HeatmapStyle& style, const Font& font) {
  HeatmapLayout out{};
  out.scale = style.scale;
  const auto px = [&](double pt) { return out.pixels(pt); };
  const HeatTable& first = figure.panels[0].table;
  const bool several = figure.panels.size() > 1;
  const size_t columns = columns_of(figure.panels.size(), style.columns);
  const size_t tasks = first.tasks.size(), envs = first.envs.size(), across = envs * columns;
  // Canvas refuses sizes far below this; the bound keeps the sums below from overflowing.
  if (std::max(tasks, across) > 100'000)
    fail(Exit::kUsage, "a side of ", std::max(tasks, across), " cells cannot be drawn");
  out.cell = px(style.cell_pt > 0 ? style.cell_pt : automatic_cell_pt(std::max(tasks, across)));
  out.gap = out.cell >= px(8) ? px(0.75) : 0;
  out.label_size = std::clamp(out.cell * 5 / 6, px(kSmallestLabelPt), px(kLabelPt));
  out.value_size = style.values ? value_size(out, font) : 0;

  out.margin = px(10);
  out.margin_space = px(5);
  out.margin_cell = std::max(out.cell, px(kNarrowestMarginPt));
  out.tree_space = px(3);
  out.tree_depth = px(kTreePt);
  const int axis_size = px(kAxisPt), space = px(5), axis = axis_size + px(7), longest = px(kLongestLabelPt);
  out.task_labels = labels(first.tasks, out.cell, out.label_size, longest, font);
  out.env_labels = labels(first.envs, out.cell, out.label_size, longest, font);
  std::vector<std::string> margin_labels;
  out.panels.resize(figure.panels.size());
  for (size_t i = 0; i < out.panels.size() && style.margins; ++i) {
    out.panels[i].margins = margins_of(figure.panels[i].table);
    for (const HeatMargin& margin : out.panels[i].margins) margin_labels.push_back(margin.name);
  }
  const int env_width = widest(out.env_labels, out.label_size, font),
            margin_width = widest(margin_labels, out.label_size, font);
  out.env_labels_up = env_width > out.cell - px(3);
  out.margin_labels_up = margin_width > out.margin_cell - px(3);
  out.bar_height = std::clamp(int(tasks) * out.cell, px(90), px(190));
  const HeatmapLegend legend = lay_out_legend(figure, out, font);

  // From left to right. Each axis' name is centred on the matrix and may be longer than it.
  const int env_axis = font.width(kEnvAxis, axis_size), task_axis = font.width(kTaskAxis, axis_size);
  const int width = int(envs) * out.cell, height = int(tasks) * out.cell;
  const int label_width = std::max(widest(out.task_labels, out.label_size, font), margin_width);
  const int left = out.margin + std::max(axis + label_width + space, (env_axis - width + 1) / 2);
  int x = left, right = 0;
  std::vector<int> headings((out.panels.size() + columns - 1) / columns);  // the highest of each row
  for (size_t i = 0; i < out.panels.size(); ++i) {
    HeatmapLayout::Panel& panel = out.panels[i];
    panel.first = i % columns == 0;
    panel.last = (i + 1) % columns == 0 || i + 1 == out.panels.size();
    if (panel.first) x = left;
    panel.matrix = {x, 0, width, height};
    const int end =
        std::max({out.right_of(panel), x + (width + env_axis + 1) / 2, several ? x + px(kNarrowestPanelPt) : 0});
    const HeatPanel& given = figure.panels[i];
    panel.heading =
        Heading(given.title, several ? panel_caption(given.table) : "", end - x, style.scale, font, kPanelTitlePt);
    headings[i / columns] = std::max(headings[i / columns], panel.heading.height());
    right = std::max(right, end);
    x = end + px(kBetweenPanelsPt);
  }
  if (figure.task_tree)
    right = std::max(right, out.right_of(out.panels[columns - 1]) + out.tree_space + out.tree_depth);
  out.legend = {right + px(22), 0, legend.width, legend.height};
  out.width = std::max(out.legend.right() + out.margin, px(kNarrowestPt));

  // From top to bottom.
  out.heading = Heading(style.title, caption_of(figure), out.width - 2 * out.margin, style.scale, font);
  const int env_depth = out.env_labels_up ? env_width : out.label_size,
            margin_depth = out.margin_labels_up ? margin_width : out.label_size;
  int y = out.margin + out.heading.height();
  for (size_t i = 0; i < out.panels.size(); ++i) {
    HeatmapLayout::Panel& panel = out.panels[i];
    if (!panel.first) {
      const HeatmapLayout::Panel& before = out.panels[i - 1];
      panel.heading_y = before.heading_y;
      panel.matrix.y = before.matrix.y;
      panel.env_labels_y = before.env_labels_y;
      panel.margin_labels_y = before.margin_labels_y;
      panel.env_axis_y = before.env_axis_y;
      continue;
    }
    panel.heading_y = y;
    y += headings[i / columns];
    if (figure.env_tree) y += out.tree_depth + out.tree_space;
    y += std::max(0, (task_axis - height + 1) / 2);
    panel.matrix.y = y;
    panel.env_labels_y = out.bottom_of(panel) + space;
    panel.margin_labels_y = y + height + space;
    const int margin_bottom = style.margins ? panel.margin_labels_y + margin_depth : 0;
    panel.env_axis_y = panel.env_labels_y + env_depth + px(6);
    // Beside a narrow matrix the axis' name reaches under the margins' names.
    if (env_axis > width) panel.env_axis_y = std::max(panel.env_axis_y, margin_bottom + px(6));
    // The names' letters reach below the digits' line by up to a third of their size.
    const int lowest_text = std::max(panel.env_axis_y + axis_size * 4 / 3, margin_bottom + out.label_size / 3);
    const int tree_scale = figure.task_tree ? panel.matrix.bottom() + tree_scale_height(Pixels{style.scale}) : 0;
    y = std::max({lowest_text, y + (height + task_axis + 1) / 2, tree_scale});
    out.height = y + out.margin;
    y += px(kBetweenPanelsPt);
  }
  out.legend.y = out.panels[0].matrix.y;
  out.height = std::max(out.height, out.legend.bottom() + out.margin);
  return out;
}

}  // namespace synpo
