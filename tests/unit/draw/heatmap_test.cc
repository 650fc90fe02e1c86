#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "draw/colour.h"
#include "draw/plot/dendrogram.h"
#include "draw/plot/heatmap.h"
#include "helpers/font.h"
#include "helpers/heat_tables.h"

namespace synpo {
namespace {

HeatFigure figure(const Matrix& matrix) { return arranged(pool_matrix(matrix)); }

TEST(Heatmap, NothingIsClippedAndLabelsKeepApart) {
  for (const int side : {1, 2, 5, 10, 20, 50, 70, 200})
    for (const double scale : {0.5, 1.0, 2.0}) {
      HeatmapStyle style;
      style.scale = scale;
      style.title =
          side % 2 ? "" : "A title that is rather long for a picture of a matrix of this size, and is wrapped";
      const HeatFigure matrix = figure(square(side));
      const HeatmapLayout layout = lay_out_heatmap(matrix, style, font());
      const Canvas canvas = draw_heatmap(matrix, style, font());
      EXPECT_EQ(canvas.clipped(), 0) << side << " at " << scale;
      EXPECT_EQ(canvas.width(), layout.width);
      EXPECT_EQ(canvas.height(), layout.height);
      EXPECT_EQ(layout.panels[0].matrix.width, side * layout.cell);
      EXPECT_GT(layout.legend.x, layout.panels[0].matrix.right());
      EXPECT_LE(layout.legend.right(), layout.width);
      const auto nameless = std::count(layout.env_labels.begin(), layout.env_labels.end(), "") +
                            std::count(layout.task_labels.begin(), layout.task_labels.end(), "");
      if (side <= 50 && scale >= 1) {
        EXPECT_EQ(nameless, 0) << side;
      }
      if (layout.value_size > 0) {
        EXPECT_LT(font().width("1.00", layout.value_size), layout.cell - layout.gap);
      }
    }
}

TEST(Heatmap, ValuesStandInTheCellsUpToFiftyAtTheDefaultScale) {
  const auto value_size = [](int side, bool values) {
    HeatmapStyle style;
    style.values = values;
    return lay_out_heatmap(figure(square(side)), style, font()).value_size;
  };
  EXPECT_GE(value_size(50, true), 14);
  EXPECT_EQ(value_size(50, false), 0);
  EXPECT_EQ(value_size(200, true), 0);
}

TEST(Heatmap, LongNamesFit) {
  const HeatFigure matrix =
      figure(square(5, std::string(300, 'e'), "put the tomato and the mug and the plate into the fridge "));
  const Canvas canvas = draw_heatmap(matrix, {}, font());
  EXPECT_EQ(canvas.clipped(), 0);
  EXPECT_LT(canvas.width(), 1500);
  const HeatmapLayout layout = lay_out_heatmap(matrix, {}, font());
  EXPECT_TRUE(layout.env_labels_up);
  EXPECT_EQ(std::set<std::string>(layout.env_labels.begin(), layout.env_labels.end()).size(), 5u);
}

TEST(Heatmap, CellsHaveTheirRampsColourAndMissingPairsAreEmpty) {
  Matrix matrix;
  matrix.rows = {matrix_row("a", "x", true, 80), matrix_row("b", "x", false, 80), matrix_row("a", "y", true, 20)};
  HeatmapStyle style;
  style.values = false;
  const Canvas canvas = draw_heatmap(figure(matrix), style, font());
  const HeatmapLayout layout = lay_out_heatmap(figure(matrix), style, font());
  const Box box = layout.panels[0].matrix;
  const auto middle = [&](int task, int env) {
    return canvas.at(box.x + env * layout.cell + layout.cell / 2, box.y + task * layout.cell + layout.cell / 3);
  };
  const Scheme& scheme = find_scheme("safe");
  EXPECT_EQ(middle(0, 0), ramp_colour(scheme.seen, 0.8));
  EXPECT_EQ(middle(0, 1), ramp_colour(scheme.unseen, 0.8));
  EXPECT_EQ(middle(1, 0), ramp_colour(scheme.seen, 0.2));
  EXPECT_EQ(middle(1, 1), kPaper);
}

TEST(Heatmap, SameBytesEveryTime) {
  const HeatFigure matrix = figure(square(7));
  const Font another;
  const std::string first = draw_heatmap(matrix, {}, font()).png();
  EXPECT_EQ(first.substr(1, 3), "PNG");
  EXPECT_EQ(first, draw_heatmap(matrix, {}, another).png());
  // No chunk that could hold a date or a host.
  for (const char* chunk : {"tIME", "tEXt", "iTXt", "zTXt"}) EXPECT_EQ(first.find(chunk), std::string::npos);
}

TEST(Heatmap, TooLargeAPictureIsRefused) {
  HeatmapStyle style;
  style.cell_pt = 200;
  style.scale = 16;
  EXPECT_THROW(draw_heatmap(figure(square(20)), style, font()), Error);
}

TEST(Panels, NothingIsClippedAndNothingMeets) {
  for (const int side : {1, 2, 5, 20, 50})
    for (const int panels : {1, 2, 3})
      for (const double scale : {0.5, 2.0}) {
        std::vector<HeatPanel> given(panels,
                                     {"A label that is longer than a small matrix is wide", pool_matrix(square(side))});
        const HeatFigure figure = arrange(given, grid_task_names(), HeatOrder::kCluster, HeatOrder::kCluster);
        HeatmapStyle style;
        style.margins = true;
        style.scale = scale;
        const HeatmapLayout layout = lay_out_heatmap(figure, style, font());
        const Canvas canvas = draw_heatmap(figure, style, font());
        EXPECT_EQ(canvas.clipped(), 0) << side << " x " << panels << " at " << scale;
        for (int i = 1; i < panels; ++i) EXPECT_GT(layout.panels[i].matrix.x, layout.right_of(layout.panels[i - 1]));
        const int tree = side > 1 ? layout.tree_space + layout.tree_depth : 0;
        EXPECT_GT(layout.legend.x, layout.right_of(layout.panels.back()) + tree);
        EXPECT_GE(layout.panels[0].matrix.y - tree, layout.panels[0].heading_y + layout.panels[0].heading.height());
        EXPECT_GE(layout.panels[0].env_labels_y, layout.bottom_of(layout.panels[0]));
      }
}

TEST(Panels, StandInRowsAndColumns) {
  const auto layout = [](int panels, int64_t columns) {
    const HeatFigure figure = arrange(std::vector<HeatPanel>(size_t(panels), {"A label", pool_matrix(square(6))}),
                                      grid_task_names(), HeatOrder::kCluster, HeatOrder::kCluster);
    HeatmapStyle style;
    style.margins = true;
    style.columns = columns;
    EXPECT_EQ(draw_heatmap(figure, style, font()).clipped(), 0) << panels << " in " << columns;
    return lay_out_heatmap(figure, style, font());
  };
  const auto in_first_row = [&](int panels, int64_t columns) {
    const HeatmapLayout out = layout(panels, columns);
    return std::count_if(out.panels.begin(), out.panels.end(),
                         [&](const HeatmapLayout::Panel& panel) { return panel.matrix.y == out.panels[0].matrix.y; });
  };
  EXPECT_EQ(in_first_row(3, 0), 3);
  EXPECT_EQ(in_first_row(4, 0), 2);
  EXPECT_EQ(in_first_row(5, 0), 3);
  EXPECT_EQ(in_first_row(5, 5), 5);
  EXPECT_EQ(in_first_row(5, 1), 1);
  EXPECT_EQ(in_first_row(2, 9), 2);
  const HeatmapLayout five = layout(5, 2);
  for (const size_t i : {0u, 2u}) {
    EXPECT_EQ(five.panels[i].matrix.x, five.panels[i + 2].matrix.x);
    EXPECT_GT(five.panels[i + 2].heading_y, five.panels[i].env_axis_y + five.pixels(kAxisPt));
  }
  EXPECT_TRUE(five.panels[4].first && five.panels[4].last);
}

TEST(Panels, MarginsAndTreesStandBesideTheirRows) {
  const HeatFigure figure =
      arrange({{"", heat_table({{"a", "x", 80}, {"b", "x", 20}, {"a", "y", 40}, {"b", "y", 40}})}}, grid_task_names(),
              HeatOrder::kCluster, HeatOrder::kCluster);
  HeatmapStyle style;
  style.values = false;
  style.margins = true;
  const HeatmapLayout layout = lay_out_heatmap(figure, style, font());
  const Canvas canvas = draw_heatmap(figure, style, font());
  const Box matrix = layout.panels[0].matrix;
  const Rgb mean_of_x = ramp_colour({0, 0}, 0.5);
  const int middle = layout.cell / 2;
  EXPECT_EQ(canvas.at(matrix.right() + layout.margin_space + middle, matrix.y + middle), mean_of_x);
  const auto inked = [&](int x, int y) {
    return canvas.at(x, y) == kSoftInk || canvas.at(x - 1, y) == kSoftInk || canvas.at(x, y - 1) == kSoftInk;
  };
  for (int leaf = 0; leaf < 2; ++leaf) {
    EXPECT_TRUE(inked(matrix.x + leaf * layout.cell + middle - 1, matrix.y - layout.tree_space - 2)) << leaf;
    EXPECT_TRUE(
        inked(layout.right_of(layout.panels[0]) + layout.tree_space + 1, matrix.y + leaf * layout.cell + middle - 1))
        << leaf;
  }
}

TEST(Panels, SameBytesEveryTime) {
  const auto bytes = [] {
    HeatmapStyle style;
    style.margins = true;
    const Font fresh;
    return draw_heatmap(arrange({{"A", pool_matrix(square(9))}, {"B", pool_matrix(square(7))}}, grid_task_names(),
                                HeatOrder::kCluster, HeatOrder::kCluster),
                        style, fresh)
        .png();
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST(Dendrogram, LabelsOfItsScaleStandSideBySide) {
  const auto steps = [](double height, double scale) {
    const Dendrogram tree{{{0, 1, height}}};
    return ticks_side_by_side(tree, int(37 * scale), font(), Pixels{scale}).at;
  };
  for (const double scale : {1.0, 1.3, 3.0}) {
    EXPECT_EQ(steps(0.14, scale), (std::vector<double>{0, 0.1})) << "0.05 and 0.10 would touch";
    EXPECT_EQ(steps(2.2, scale), (std::vector<double>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace synpo
