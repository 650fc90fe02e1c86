#include <gtest/gtest.h>

#include <stdexcept>

#include "base/error.h"
#include "helpers/heat_tables.h"

namespace synpo {
namespace {

using Names = std::vector<std::string>;

TEST(Order, OfThePaper) {
  std::vector<HeatPair> pairs;
  for (const char* env : {"map10", "map2", "map1"})
    for (const char* task : {"R-G", "P-R", "R-B"}) pairs.push_back({env, task, 1});
  const HeatTable figure6 = arranged(heat_table(pairs), HeatOrder::kPaper).panels[0].table;
  EXPECT_EQ(figure6.envs, (Names{"map1", "map2", "map10"}));
  EXPECT_EQ(figure6.tasks, (Names{"R-B", "P-R", "R-G"}));
  pairs.push_back({"map1", "A-task", 1});
  EXPECT_EQ(arranged(heat_table(pairs), HeatOrder::kPaper).panels[0].table.tasks,
            (Names{"R-G", "P-R", "R-B", "A-task"}));
}

TEST(Order, GivenNaturalAndMeanOfEitherAxis) {
  const HeatTable one =
      heat_table({{"e10", "t9", 10}, {"e2", "t9", 50}, {"e10", "t10", 90}, {"e2", "t10", 50}, {"e2", "t1", 95}});
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
  const HeatFigure figure = arranged(
      heat_table({{"a", "x", 100}, {"b", "x", 0}, {"a", "y", 0}, {"b", "y", 100}, {"a", "z", 80}, {"b", "z", 20}}),
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
  const HeatFigure figure = arranged(heat_table({{"a", "p", 50}, {"b", "q", 50}, {"a", "r", 60}, {"b", "r", 80}}),
                                     HeatOrder::kCluster, HeatOrder::kCluster);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[0].height, 0.1);
  EXPECT_DOUBLE_EQ(figure.task_tree->merges[1].height, (1 + 0.3) / 2);
  EXPECT_EQ(figure.panels[0].table.tasks, (Names{"r", "p", "q"}));
  // One name has no tree.
  EXPECT_FALSE(
      arranged(heat_table({{"a", "p", 50}, {"a", "q", 50}}), HeatOrder::kCluster, HeatOrder::kCluster).env_tree);
}

}  // namespace
}  // namespace synpo
