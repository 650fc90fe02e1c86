#include "draw/heatmap.h"

#include "draw/heatmap_legend.h"

namespace synpo {
namespace {

constexpr double kPartNamePt = 6;

// Lines where two neighbours belong to different parts.
void draw_part_borders(Canvas& canvas, const HeatTable& table, const HeatmapLayout& layout) {
  const int line = layout.pixels(1.5), cell = layout.cell, back = (line + layout.gap) / 2;
  for (size_t task = 0; task < table.tasks.size(); ++task)
    for (size_t env = 0; env < table.envs.size(); ++env) {
      const int x = layout.matrix.x + int(env) * cell - back, y = layout.matrix.y + int(task) * cell - back;
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

void draw_cells(Canvas& canvas, const HeatTable& table, const HeatmapLayout& layout, const Scheme& scheme) {
  const int name_size = layout.pixels(kPartNamePt), inset = layout.pixels(2), envs = int(table.envs.size());
  std::vector<bool> named(table.cells.size());
  if (!table.parts.empty() && layout.cell >= 3 * name_size) named = cells_that_name_parts(table);
  for (int i = 0; i < int(table.cells.size()); ++i) {
    const HeatCell& cell = table.cells[i];
    const int side = layout.cell - layout.gap;
    const Box box = {layout.matrix.x + i % envs * layout.cell, layout.matrix.y + i / envs * layout.cell, side, side};
    const Rgb ground = cell.evaluated() ? ramp_colour(group_ramp(table, cell.group, scheme), cell.rate()) : kPaper;
    if (cell.evaluated())
      canvas.fill(box, ground);
    else if (layout.gap > 0)
      draw_empty_cell(canvas, box, layout.pixels(0.5));
    if (named[i])
      canvas.text(box.x + inset, box.y + inset, canvas.font().fitted(table.parts[cell.part].name, name_size, side - 2 * inset),
                  name_size, ink_on(ground));
    if (cell.evaluated() && layout.value_size > 0)
      canvas.text(box.x + side / 2, box.y + side / 2 + (named[i] ? layout.pixels(3) : 0), rate_text(cell.successes, cell.episodes),
                  layout.value_size, ink_on(ground), Across::kCentre, Upright::kMiddle);
  }
}

void draw_labels(Canvas& canvas, const HeatTable& table, const HeatmapLayout& layout) {
  const Box& matrix = layout.matrix;
  const int space = layout.pixels(5), middle = (layout.cell - layout.gap) / 2;
  for (size_t i = 0; i < table.tasks.size(); ++i)
    canvas.text(matrix.x - space, matrix.y + int(i) * layout.cell + middle, layout.task_labels[i], layout.label_size, kInk,
                Across::kRight, Upright::kMiddle);
  for (size_t i = 0; i < table.envs.size(); ++i) {
    const int x = matrix.x + int(i) * layout.cell + middle, y = matrix.bottom() + space;
    if (layout.env_labels_up)
      canvas.text_up(x, y, layout.env_labels[i], layout.label_size, kInk, Across::kRight);
    else
      canvas.text(x, y, layout.env_labels[i], layout.label_size, kInk, Across::kCentre);
  }
  canvas.text_up(layout.margin + layout.axis_size / 2, matrix.y + matrix.height / 2, kTaskAxis, layout.axis_size, kSoftInk,
                 Across::kCentre);
  canvas.text(matrix.x + matrix.width / 2, layout.env_axis_y, kEnvAxis, layout.axis_size, kSoftInk, Across::kCentre);
}

}  // namespace

Canvas draw_heatmap(const HeatTable& table, const HeatmapStyle& style, const Font& font) {
  const Scheme& scheme = find_scheme(style.scheme);
  const HeatmapLayout layout = lay_out_heatmap(table, style, font);
  Canvas canvas(layout.width, layout.height, font);
  int y = layout.margin;
  for (const std::string& line : layout.title) {
    canvas.text(layout.margin, y, line, layout.title_size, kInk);
    y += layout.title_line;
  }
  for (const std::string& line : layout.caption) {
    canvas.text(layout.margin, y, line, layout.caption_size, kSoftInk);
    y += layout.caption_line;
  }
  draw_cells(canvas, table, layout, scheme);
  draw_labels(canvas, table, layout);
  if (!table.parts.empty()) draw_part_borders(canvas, table, layout);
  draw_legend(canvas, table, layout, scheme);
  return canvas;
}

}  // namespace synpo
