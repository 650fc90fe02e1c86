#include "draw/plot/heatmap.h"

#include <cstddef>
#include <optional>

#include "base/rgb.h"
#include "draw/colour.h"
#include "draw/plot/dendrogram.h"
#include "draw/plot/heatmap_legend.h"

namespace synpo {
namespace {

constexpr double kPartNamePt = 6;

// Lines where two neighbours belong to different parts.
void draw_part_borders(Canvas& canvas, const HeatTable& table, const Box& matrix, const HeatmapLayout& layout) {
  const int line = layout.pixels(1.5), cell = layout.cell, back = (line + layout.gap) / 2;
  for (size_t task = 0; task < table.tasks.size(); ++task)
    for (size_t env = 0; env < table.envs.size(); ++env) {
      const int x = matrix.x + int(env) * cell - back, y = matrix.y + int(task) * cell - back;
      const int part = table.at(task, env).part;
      const auto borders_on = [&](int other) { return part >= 0 && other >= 0 && part != other; };
      if (env > 0 && borders_on(table.at(task, env - 1).part)) canvas.fill({x, y, line, cell + line}, kInk);
      if (task > 0 && borders_on(table.at(task - 1, env).part)) canvas.fill({x, y, cell + line, line}, kInk);
    }
}

// True for the first cell in reading order of each connected area of one part: there its name stands.
std::vector<bool> cells_that_name_parts(const HeatTable& table) {
  const int envs = int(table.envs.size()), cells = int(table.cells.size());
  std::vector<bool> reached(table.cells.size()), names(table.cells.size());
  for (int first = 0; first < cells; ++first) {
    const int part = table.cells[first].part;
    if (part < 0 || reached[first]) continue;
    names[first] = reached[first] = true;
    std::vector<int> open = {first};
    while (!open.empty()) {
      const int at = open.back(), env = at % envs;
      open.pop_back();
      const int neighbours[] = {at - envs, at + envs, env > 0 ? at - 1 : -1, env + 1 < envs ? at + 1 : -1};
      for (const int next : neighbours)
        if (next >= 0 && next < cells && !reached[next] && table.cells[next].part == part) {
          reached[next] = true;
          open.push_back(next);
        }
    }
  }
  return names;
}

struct ShownRate {
  double rate;
  std::string text;
};

// Without a rate: not evaluated.
void draw_cell(Canvas& canvas, const Box& box, const std::optional<ShownRate>& rate, const Ramp& ramp,
               const HeatmapLayout& layout, const std::string& part = "") {
  const Rgb ground = rate ? ramp_colour(ramp, rate->rate) : kPaper;
  if (rate)
    canvas.fill(box, ground);
  else if (layout.gap > 0)
    draw_empty_cell(canvas, box, layout.pixels(0.5));
  const int inset = layout.pixels(2), part_size = layout.pixels(kPartNamePt);
  if (!part.empty())
    canvas.text(box.x + inset, box.y + inset, canvas.font().fitted(part, part_size, box.width - 2 * inset), part_size,
                ink_on(ground));
  if (rate && layout.value_size > 0)
    canvas.text(box.x + box.width / 2, box.y + box.height / 2 + (part.empty() ? 0 : layout.pixels(3)), rate->text,
                layout.value_size, ink_on(ground), Across::kCentre, Upright::kMiddle);
}

void draw_cells(Canvas& canvas, const HeatTable& table, const Box& matrix, const HeatmapLayout& layout,
                const Scheme& scheme) {
  const int envs = int(table.envs.size()), side = layout.cell - layout.gap;
  std::vector<bool> named(table.cells.size());
  if (!table.parts.empty() && layout.cell >= 3 * layout.pixels(kPartNamePt)) named = cells_that_name_parts(table);
  // Beneath cells without a gap, lest seams between them show.
  if (layout.gap == 0) {
    std::vector<Rgb> colours;
    for (const HeatCell& cell : table.cells)
      colours.push_back(cell.evaluated() ? ramp_colour(group_ramp(table, cell.group, scheme), cell.rate()) : kPaper);
    canvas.squares(matrix.x, matrix.y, layout.cell, envs, colours);
  }
  for (int i = 0; i < int(table.cells.size()); ++i) {
    const HeatCell& cell = table.cells[i];
    const Box box = {matrix.x + i % envs * layout.cell, matrix.y + i / envs * layout.cell, side, side};
    std::optional<ShownRate> shown;
    if (table.split && cell.group >= 0) shown = {kSplitShade, ""};
    if (cell.evaluated()) shown = {cell.rate(), rate_text(cell.successes, cell.episodes)};
    draw_cell(canvas, box, shown, group_ramp(table, cell.group, scheme), layout,
              named[i] ? table.parts[cell.part].name : "");
  }
}

// To the right of the matrix the means of its tasks, below it those of its environments.
void draw_margins(Canvas& canvas, const HeatTable& table, const HeatmapLayout::Panel& panel,
                  const HeatmapLayout& layout, const Scheme& scheme) {
  const Box& matrix = panel.matrix;
  const int across = layout.margin_cell - layout.gap, side = layout.cell - layout.gap, space = layout.pixels(5);
  for (size_t i = 0; i < panel.margins.size(); ++i) {
    const HeatMargin& margin = panel.margins[i];
    const Ramp& ramp = group_ramp(table, margin.group, scheme);
    const int offset = layout.margin_space + int(i) * layout.margin_cell, x = matrix.right() + offset,
              y = matrix.bottom() + offset;
    const auto draw = [&](const Box& box, const HeatMean& line) {
      if (line.evaluated()) draw_cell(canvas, box, ShownRate{line.mean(), rate_text(line)}, ramp, layout);
    };
    for (size_t task = 0; task < margin.tasks.size(); ++task)
      draw({x, matrix.y + int(task) * layout.cell, across, side}, margin.tasks[task]);
    for (size_t env = 0; env < margin.envs.size(); ++env)
      draw({matrix.x + int(env) * layout.cell, y, side, across}, margin.envs[env]);
    if (layout.margin_labels_up)
      canvas.text_up(x + across / 2, panel.margin_labels_y, margin.name, layout.label_size, kInk, Across::kRight);
    else
      canvas.text(x + across / 2, panel.margin_labels_y, margin.name, layout.label_size, kInk, Across::kCentre);
    if (panel.first)
      canvas.text(matrix.x - space, y + across / 2, margin.name, layout.label_size, kInk, Across::kRight,
                  Upright::kMiddle);
  }
}

void draw_task_labels(Canvas& canvas, const Box& matrix, const HeatmapLayout& layout) {
  const int middle = (layout.cell - layout.gap) / 2;
  for (size_t i = 0; i < layout.task_labels.size(); ++i)
    canvas.text(matrix.x - layout.pixels(5), matrix.y + int(i) * layout.cell + middle, layout.task_labels[i],
                layout.label_size, kInk, Across::kRight, Upright::kMiddle);
  const int size = layout.pixels(kAxisPt);
  canvas.text_up(layout.margin + size / 2, matrix.y + matrix.height / 2, kTaskAxis, size, kSoftInk, Across::kCentre);
}

void draw_env_labels(Canvas& canvas, const HeatmapLayout::Panel& panel, const HeatmapLayout& layout) {
  const Box& matrix = panel.matrix;
  const int middle = (layout.cell - layout.gap) / 2;
  for (size_t i = 0; i < layout.env_labels.size(); ++i) {
    const int x = matrix.x + int(i) * layout.cell + middle;
    if (layout.env_labels_up)
      canvas.text_up(x, panel.env_labels_y, layout.env_labels[i], layout.label_size, kInk, Across::kRight);
    else
      canvas.text(x, panel.env_labels_y, layout.env_labels[i], layout.label_size, kInk, Across::kCentre);
  }
  canvas.text(matrix.x + matrix.width / 2, panel.env_axis_y, kEnvAxis, layout.pixels(kAxisPt), kSoftInk,
              Across::kCentre);
}

// Beside the last panel of a row the tree of the tasks, above each panel that of the environments.
void draw_trees(Canvas& canvas, const HeatFigure& figure, const HeatmapLayout::Panel& panel,
                const HeatmapLayout& layout) {
  const Pixels px{layout.scale};
  const int line = px(0.6), middle = (layout.cell - layout.gap - line) / 2;
  const Box& matrix = panel.matrix;
  if (figure.task_tree && panel.last) {
    const int x = layout.right_of(panel) + layout.tree_space;
    draw_tree_right(canvas, *figure.task_tree, x, matrix.y + middle, layout.cell, layout.tree_depth, line);
    draw_scale_beneath(canvas, *figure.task_tree, x, matrix.bottom(), layout.tree_depth, line, px);
  }
  if (figure.env_tree) {
    const int y = matrix.y - layout.tree_space;
    draw_tree_up(canvas, *figure.env_tree, matrix.x + middle, y, layout.cell, layout.tree_depth, line);
    if (panel.first) draw_scale_left(canvas, *figure.env_tree, matrix.x, y, layout.tree_depth, line, px);
  }
}

}  // namespace

Canvas draw_heatmap(const HeatFigure& figure, const HeatmapStyle& style, const Font& font) {
  const Scheme& scheme = find_scheme(style.scheme);
  const HeatmapLayout layout = lay_out_heatmap(figure, style, font);
  Canvas canvas(layout.width, layout.height, font, style.scale);
  layout.heading.draw(canvas, layout.margin, layout.margin);
  for (size_t i = 0; i < layout.panels.size(); ++i) {
    const HeatTable& table = figure.panels[i].table;
    const HeatmapLayout::Panel& panel = layout.panels[i];
    panel.heading.draw(canvas, panel.matrix.x, panel.heading_y);
    draw_cells(canvas, table, panel.matrix, layout, scheme);
    if (panel.first) draw_task_labels(canvas, panel.matrix, layout);
    draw_env_labels(canvas, panel, layout);
    draw_margins(canvas, table, panel, layout, scheme);
    if (!table.parts.empty()) draw_part_borders(canvas, table, panel.matrix, layout);
    draw_trees(canvas, figure, panel, layout);
  }
  draw_legend(canvas, figure, layout, scheme);
  return canvas;
}

}  // namespace synpo
