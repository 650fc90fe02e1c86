// synpo-render heatmap: success matrices, one or several side by side.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "draw/canvas/font.h"
#include "draw/colour.h"
#include "draw/plot/heatmap.h"
#include "draw/terminal/terminal.h"
#include "format/matrix.h"
#include "render/render.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/merge.h"
#include "world/grid/task.h"

using namespace synpo;

namespace {

struct PanelMatrix {
  std::string title;
  Matrix matrix;
};

struct PanelChoice {
  std::string by = "file", method, colours = "seen";
};

constexpr size_t kMostPanels = 100;

// The matrix whole, or one for each method or seed, in the order of their first rows.
std::vector<PanelMatrix> split(const Matrix& matrix, const PanelChoice& choice) {
  if (choice.by == "file") return {{"", matrix}};
  std::vector<PanelMatrix> out;
  for (const MatrixRow& row : matrix.rows) {
    if (!choice.method.empty() && row.method != choice.method) continue;
    const std::string title = choice.by == "seed" ? concat("seed ", row.seed) : row.method;
    auto panel = std::find_if(out.begin(), out.end(), [&](const PanelMatrix& other) { return other.title == title; });
    if (panel == out.end() && out.size() == kMostPanels)
      fail(Exit::kData, "more than ", kMostPanels, " panels cannot be drawn");
    if (panel == out.end()) panel = out.insert(out.end(), {title, {{}, matrix.has_part, matrix.extra_columns}});
    panel->matrix.rows.push_back(row);
  }
  return out;
}

std::vector<HeatPanel> read_panels(const std::vector<LabelledFiles>& files, const PanelChoice& choice) {
  std::vector<HeatPanel> panels;
  for (const LabelledFiles& one : files) {
    for (const PanelMatrix& part : split(read_matrices(one.paths, true), choice)) {
      const std::string title = one.label + (one.label.empty() || part.title.empty() ? "" : ", ") + part.title;
      try {
        panels.push_back({title, pool_matrix(part.matrix, choice.method, choice.colours == "part")});
      } catch (const Error& error) {
        throw error.at(title.empty() ? "" : quoted(title) + ": ");
      }
    }
  }
  if (panels.empty()) fail(Exit::kData, "no row of the method ", quoted(choice.method));
  return panels;
}

// Tasks "O-R" as "(O, R)", environments by their place in natural order: map1 as env_0. A task of another name keeps
// it.
void name_as_paper(HeatFigure& figure) {
  std::vector<std::string> envs = figure.panels[0].table.envs;
  std::sort(envs.begin(), envs.end(), natural_less);
  for (HeatPanel& panel : figure.panels) {
    for (std::string& env : panel.table.envs)
      env = concat("env_", std::lower_bound(envs.begin(), envs.end(), env, natural_less) - envs.begin());
    for (std::string& task : panel.table.tasks)
      if (const size_t dash = task.find('-'); dash != std::string::npos)
        task = concat("(", task.substr(0, dash), ", ", task.substr(dash + 1), ")");
  }
}

std::string ansi(const HeatFigure& figure, const HeatmapStyle& style, TerminalColour colour, int width) {
  std::string text = style.title.empty() ? "" : style.title + "\n\n";
  for (const HeatPanel& panel : figure.panels) {
    if (&panel != &figure.panels[0]) text += '\n';
    if (!panel.title.empty()) text += panel.title + '\n';
    text += terminal_matrix(panel.table, find_scheme(style.scheme), colour, width);
  }
  return text;
}

}  // namespace

int heatmap(int argc, char** argv) {
  HeatmapStyle style;
  PictureOptions picture;
  PanelChoice choice;
  std::string labels = "own";
  HeatOrder order = HeatOrder::kPaper;
  std::optional<HeatOrder> task_order, env_order;
  bool no_values = false;
  const std::vector<std::string> orders = {"paper", "given", "natural", "mean", "cluster"};
  Options options("synpo-render heatmap", "[OPTION]... [[LABEL=]MATRIX[,MATRIX]...]...",
                  "Draws success matrices side by side: tasks down, environments across, darker is better.");
  options.choice(0, "panels", "WHAT", "a panel for each file, method or seed", choice.by, {"file", "method", "seed"})
      .text(0, "method", "NAME", "only the rows of this method", choice.method)
      .call(0, "order", "ORDER", "of tasks and environments: paper, given, natural, mean or cluster [paper]",
            [&](const std::string& name) { order = find_order(name); })
      .suggest(orders)
      .call(0, "task-order", "ORDER", "of tasks alone", [&](const std::string& name) { task_order = find_order(name); })
      .suggest(orders)
      .call(0, "env-order", "ORDER", "of environments alone",
            [&](const std::string& name) { env_order = find_order(name); })
      .suggest(orders)
      .flag(0, "margins", "the mean of each task and each environment", style.margins)
      .call(0, "scheme", "NAME", "safe, purple-red, blue-red or figure8 [safe]",
            [&](const std::string& name) { style.scheme = find_scheme(name).name; })
      .suggest(scheme_names())
      .choice(0, "by", "COLUMN", "what the colours tell apart: seen or part", choice.colours, {"seen", "part"})
      .flag(0, "no-values", "leave the rates out of the cells", no_values)
      .real(0, "cell", "POINTS", "side of a cell; 0: by the size of the matrix", style.cell_pt, 0, 200)
      .integer(0, "columns", "N", "panels in a row; 0: up to three, more in rows", style.columns, 0, 100)
      .choice(0, "labels", "KIND", "own names, or the paper's: (O, R) and env_0", labels, {"own", "paper"})
      .call(0, "title", "TEXT", "title above the picture", drawn(style.title));
  picture.add_ansi(options);
  picture.add_to(options);
  const std::vector<LabelledFiles> files = labelled_files(options.parse(argc, argv, 0, 1000));
  picture.settle(options, {"margins", "no-values", "cell", "columns"});
  style.values = !no_values;
  style.scale = picture.scale;
  Output output = picture.open();
  const auto read_figure = [&] {
    HeatFigure figure =
        arrange(read_panels(files, choice), grid_task_names(), task_order.value_or(order), env_order.value_or(order));
    if (labels == "paper") name_as_paper(figure);
    return figure;
  };
  if (picture.ansi) {
    finish(output, ansi(read_figure(), style, picture.colour.of(output), picture.width(output)));
    return 0;
  }
  const Font font(picture.font);
  picture.finish(output, draw_heatmap(read_figure(), style, font));
  return 0;
}
