#include <gtest/gtest.h>

#include <stdexcept>

#include "base/error.h"
#include "draw/plot/heatmap.h"
#include "world/grid/task.h"

namespace synpo {
namespace {

using Names = std::vector<std::string>;

const Font& font() {
  static const Font shared;
  return shared;
}

struct Pair {
  const char *env, *task;
  int64_t successes;
  bool seen = true;
};

HeatTable table(const std::vector<Pair>& pairs) {
  Matrix matrix;
  for (const Pair& pair : pairs) {
    MatrixRow row;
    row.env = pair.env;
    row.task = pair.task;
    row.seen = pair.seen;
    row.successes = pair.successes;
    row.episodes = 100;
    matrix.rows.push_back(row);
  }
  return pool_matrix(matrix);
}

HeatTable square(int side) {
  std::vector<std::string> names;
  std::vector<Pair> pairs;
  for (int i = 0; i < side; ++i) names.push_back("name" + std::to_string(i));
  for (int task = 0; task < side; ++task)
    for (int env = 0; env < side; ++env)
      pairs.push_back({names[env].c_str(), names[task].c_str(), (env * 37 + task * 11) % 101, (env + task) % 3 == 0});
  return table(pairs);
}

HeatFigure arranged(const HeatTable& one, HeatOrder tasks, HeatOrder envs = HeatOrder::kPaper) {
  return arrange({{"", one}}, grid_task_names(), tasks, envs);
}

TEST(Order, OfThePaper) {
  std::vector<Pair> pairs;
  for (const char* env : {"map10", "map2", "map1"})
    for (const char* task : {"R-G", "P-R", "R-B"}) pairs.push_back({env, task, 1});
  const HeatTable figure6 = arranged(table(pairs), HeatOrder::kPaper).panels[0].table;
  EXPECT_EQ(figure6.envs, (Names{"map1", "map2", "map10"}));
  EXPECT_EQ(figure6.tasks, (Names{"R-B", "P-R", "R-G"}));
  pairs.push_back({"map1", "A-task", 1});
  EXPECT_EQ(arranged(table(pairs), HeatOrder::kPaper).panels[0].table.tasks, (Names{"R-G", "P-R", "R-B", "A-task"}));
}

TEST(Order, GivenNaturalAndMeanOfEitherAxis) {
  const HeatTable one =
      table({{"e10", "t9", 10}, {"e2", "t9", 50}, {"e10", "t10", 90}, {"e2", "t10", 50}, {"e2", "t1", 95}});
  const auto names = [&](HeatOrder tasks, HeatOrder envs) {
    const HeatTable out = arranged(one, tasks, envs).panels[0].table;
    return std::pair(out.tasks, out.envs);
  };
  EXPECT_EQ(names(HeatOrder::kGiven, HeatOrder::kNatural), std::pair(Names({"t9", "t10", "t1"}), Names({"e2", "e10"})));
  EXPECT_EQ(names(HeatOrder::kNatural, HeatOrder::kGiven), std::pair(Names({"t1", "t9", "t10"}), Names({"e10", "e2"})));
  // Means: t1 0.95, t10 0.70, t9 0.30; e2 0.65, e10 0.50.
  EXPECT_EQ(names(HeatOrder::kMean, HeatOrder::kMean), std::pair(Names({"t1", "t10", "t9"}), Names({"e2", "e10"})));
  const HeatTable sorted = arranged(one, HeatOrder::kMean, HeatOrder::kMean).panels[0].table;
  EXPECT_EQ(sorted.at(0, 0).successes, 95);
  EXPECT_FALSE(sorted.at(0, 1).evaluated());
  EXPECT_EQ(sorted.at(1, 1).successes, 90);
  EXPECT_THROW(find_order("best"), std::invalid_argument);
}

TEST(Order, ClusterByHand) {
  // x and z: sqrt((0.2^2 + 0.2^2) / 2) = 0.2; x and y: 1; y and z: 0.8, so y joins at 0.9. All means are 0.5.
  const HeatFigure figure =
      arranged(table({{"a", "x", 100}, {"b", "x", 0}, {"a", "y", 0}, {"b", "y", 100}, {"a", "z", 80}, {"b", "z", 20}}),
               HeatOrder::kCluster);
  EXPECT_EQ(figure.panels[0].table.tasks, (Names{"x", "z", "y"}));
  EXPECT_EQ(figure.panels[0].table.envs, (Names{"a", "b"}));
  ASSERT_TRUE(figure.task_tree);
  EXPECT_FALSE(figure.env_tree);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[0].height, 0.2);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[1].height, 0.9);
  EXPECT_EQ(figure.task_tree->order(), (std::vector<size_t>{0, 2, 1}));
}

TEST(Order, ClusterPassesOverGaps) {
  // p and q share no environment: 1 apart. r is as far from either as their one common pair says: 0.1 and 0.3.
  const HeatFigure figure = arranged(table({{"a", "p", 50}, {"b", "q", 50}, {"a", "r", 60}, {"b", "r", 80}}),
                                     HeatOrder::kCluster, HeatOrder::kCluster);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[0].height, 0.1);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[1].height, (1 + 0.3) / 2);
  EXPECT_EQ(figure.panels[0].table.tasks, (Names{"r", "p", "q"}));
  // One name has no tree.
  EXPECT_FALSE(arranged(table({{"a", "p", 50}, {"a", "q", 50}}), HeatOrder::kCluster, HeatOrder::kCluster).env_tree);
}

TEST(Panels, HaveTheNamesAndKindsOfAny) {
  const HeatFigure figure = arrange(
      {{"first", table({{"e1", "x", 10, false}})}, {"second", table({{"e1", "y", 30, true}, {"e0", "x", 50, true}})}},
      grid_task_names());
  for (const HeatPanel& panel : figure.panels) {
    EXPECT_EQ(panel.table.envs, (Names{"e0", "e1"}));
    EXPECT_EQ(panel.table.tasks, (Names{"x", "y"}));
    ASSERT_EQ(panel.table.groups.size(), 2u);
    EXPECT_EQ(panel.table.groups[0].name, "seen");
    EXPECT_EQ(panel.table.groups[1].name, "unseen");
  }
  const HeatTable &first = figure.panels[0].table, &second = figure.panels[1].table;
  EXPECT_EQ(first.at(0, 1).successes, 10);
  EXPECT_EQ(first.at(0, 1).group, 1);
  EXPECT_FALSE(first.at(0, 0).evaluated());
  EXPECT_EQ(second.at(0, 0).successes, 50);
  EXPECT_EQ(second.at(0, 0).group, 0);
  EXPECT_EQ(first.groups[0].pairs, 0);
  EXPECT_EQ(second.groups[0].pairs, 2);
}

TEST(Panels, AreOrderedTogether) {
  // Over both panels y is the better one.
  const HeatFigure figure =
      arrange({{"", table({{"e", "x", 60}, {"e", "y", 50}})}, {"", table({{"e", "x", 20}, {"e", "y", 90}})}},
              grid_task_names(), HeatOrder::kMean);
  for (const HeatPanel& panel : figure.panels) EXPECT_EQ(panel.table.tasks, (Names{"y", "x"}));
}

TEST(Panels, TooManyNamesAreRefused) {
  std::vector<std::string> names;
  for (int i = 0; i < 100'001; ++i) names.push_back("e" + std::to_string(i));
  std::vector<Pair> pairs;
  for (const std::string& name : names) pairs.push_back({name.c_str(), "t", 1});
  EXPECT_THROW(table(pairs), Error);
  pairs.resize(2001);
  EXPECT_THROW(arranged(table(pairs), HeatOrder::kPaper, HeatOrder::kCluster), Error);
  EXPECT_NO_THROW(arranged(table(pairs), HeatOrder::kCluster, HeatOrder::kMean));
}

TEST(Margins, MeansOfTheLineAndOfEachOfItsKinds) {
  const HeatTable one =
      arranged(table({{"a", "x", 80, true}, {"b", "x", 20, false}, {"a", "y", 40, true}}), HeatOrder::kPaper)
          .panels[0]
          .table;
  const std::vector<HeatMargin> margins = margins_of(one);
  ASSERT_EQ(margins.size(), 3u);
  EXPECT_EQ(margins[0].name, "mean");
  EXPECT_DOUBLE_EQ(margins[0].tasks[0].mean(), 0.5);
  EXPECT_DOUBLE_EQ(margins[0].envs[0].mean(), 0.6);
  EXPECT_EQ(margins[1].name, "mean seen");
  EXPECT_DOUBLE_EQ(margins[1].tasks[0].mean(), 0.8);
  EXPECT_EQ(margins[2].name, "mean unseen");
  EXPECT_DOUBLE_EQ(margins[2].envs[1].mean(), 0.2);
  EXPECT_FALSE(margins[2].tasks[1].evaluated());
  // One kind has no mean apart from that of all.
  EXPECT_EQ(margins_of(table({{"a", "x", 80}})).size(), 1u);
}

TEST(Margins, EveryPairCountsAlikeWhateverItsEpisodes) {
  Matrix matrix;
  for (const int64_t episodes : {10, 90}) {
    MatrixRow row;
    row.env = "e" + std::to_string(episodes);
    row.task = "t";
    row.seen = true;
    row.episodes = episodes;
    row.successes = episodes == 10 ? 10 : 45;
    matrix.rows.push_back(row);
  }
  const HeatTable one = pool_matrix(matrix);
  EXPECT_DOUBLE_EQ(margins_of(one)[0].tasks[0].mean(), 0.75);
  EXPECT_DOUBLE_EQ(one.groups[0].mean(), 0.75);
  EXPECT_DOUBLE_EQ(one.groups[0].rate(), 0.55);
  EXPECT_EQ(rate_text(margins_of(one)[0].envs[0].mean()), "1.00");
}

TEST(Panels, NothingIsClippedAndNothingMeets) {
  for (const int side : {1, 2, 5, 20, 50})
    for (const int panels : {1, 2, 3})
      for (const double scale : {0.5, 2.0}) {
        std::vector<HeatPanel> given(panels, {"A label that is longer than a small matrix is wide", square(side)});
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
        EXPECT_GE(layout.env_labels_y, layout.bottom_of(layout.panels[0]));
      }
}

TEST(Panels, MarginsAndTreesStandBesideTheirRows) {
  const HeatFigure figure = arrange({{"", table({{"a", "x", 80}, {"b", "x", 20}, {"a", "y", 40}, {"b", "y", 40}})}},
                                    grid_task_names(), HeatOrder::kCluster, HeatOrder::kCluster);
  HeatmapStyle style;
  style.values = false;
  style.margins = true;
  const HeatmapLayout layout = lay_out_heatmap(figure, style, font());
  const Canvas canvas = draw_heatmap(figure, style, font());
  const Box matrix = layout.panels[0].matrix;
  const auto same = [](Rgb a, Rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; };
  const Rgb mean_of_x = ramp_colour({0, 0}, 0.5);
  const int middle = layout.cell / 2;
  EXPECT_TRUE(same(canvas.at(matrix.right() + layout.margin_space + middle, matrix.y + middle), mean_of_x));
  const auto inked = [&](int x, int y) {
    return same(canvas.at(x, y), kSoftInk) || same(canvas.at(x - 1, y), kSoftInk) ||
           same(canvas.at(x, y - 1), kSoftInk);
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
    return draw_heatmap(arrange({{"A", square(9)}, {"B", square(7)}}, grid_task_names(), HeatOrder::kCluster,
                                HeatOrder::kCluster),
                        style, fresh)
        .png();
  };
  EXPECT_EQ(bytes(), bytes());
}

}  // namespace
}  // namespace synpo
