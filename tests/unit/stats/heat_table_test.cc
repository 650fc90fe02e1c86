#include "stats/matrix/heat_table.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "helpers/heat_tables.h"

namespace synpo {
namespace {

using Names = std::vector<std::string>;

Exit failure(const Matrix& matrix, const std::string& method = "", bool by_part = false) {
  try {
    pool_matrix(matrix, method, by_part);
  } catch (const Error& error) {
    return error.code();
  }
  return Exit::kOk;
}

TEST(Pool, SumsRunsAndMeansOfGroups) {
  Matrix matrix;
  matrix.rows = {matrix_row("a", "x", true, 10), matrix_row("a", "x", true, 70), matrix_row("b", "x", false, 30),
                 matrix_row("c", "y", false, 50, 50)};
  matrix.rows[1].run = "00000000000000bb";
  const HeatTable table = pool_matrix(matrix);
  EXPECT_EQ(table.at(0, 0).episodes, 200);
  EXPECT_EQ(table.at(0, 0).successes, 80);
  EXPECT_FALSE(table.at(1, 0).evaluated());
  ASSERT_EQ(table.groups.size(), 2u);
  EXPECT_EQ(table.groups[0].name, "seen");
  EXPECT_DOUBLE_EQ(table.groups[0].rate(), 0.4);
  EXPECT_EQ(table.groups[1].pairs, 2);
  EXPECT_DOUBLE_EQ(table.groups[1].rate(), 80.0 / 150);
  EXPECT_EQ(table.caption, "synpo, 2 runs, 50 to 200 episodes a pair");
}

TEST(Pool, RefusesWhatCannotBePooled) {
  Matrix matrix = square(2);
  EXPECT_EQ(failure(matrix), Exit::kOk);
  EXPECT_EQ(failure(matrix, "mlp"), Exit::kData);
  EXPECT_EQ(failure(matrix, "", true), Exit::kData);
  Matrix other = matrix;
  other.rows.push_back(matrix_row("map1", "task1", !matrix.rows[0].seen, 1));
  EXPECT_EQ(failure(other), Exit::kData);
  other = matrix;
  other.rows.back().window = 0;
  EXPECT_EQ(failure(other), Exit::kData);
  other = matrix;
  other.rows.back().temperature = 0.25;
  EXPECT_EQ(failure(other), Exit::kData);
  other = matrix;
  other.rows.back().method = "mlp";
  EXPECT_EQ(failure(other), Exit::kData);
  EXPECT_EQ(failure(other, "synpo"), Exit::kOk);
}

TEST(Pool, PartsHaveMeansOfTheirOwn) {
  Matrix matrix;
  matrix.has_part = true;
  matrix.rows = {matrix_row("a", "x", true, 90), matrix_row("b", "x", true, 50), matrix_row("c", "x", false, 30)};
  matrix.rows[0].part = "P";
  matrix.rows[1].part = "Q";
  matrix.rows[2].part = "rest";
  const HeatTable by_seen = pool_matrix(matrix), by_part = pool_matrix(matrix, "", true);
  ASSERT_EQ(by_seen.parts.size(), 3u);
  EXPECT_DOUBLE_EQ(by_seen.parts[1].rate(), 0.5);
  EXPECT_FALSE(by_seen.by_part);
  EXPECT_TRUE(by_part.by_part);
  ASSERT_EQ(by_part.groups.size(), 3u);
  EXPECT_EQ(by_part.groups[2].name, "rest");
}

TEST(RateText, OneAndZeroOnlyWhereAllOrNoneSucceeded) {
  EXPECT_EQ(rate_text(0, 100), "0.00");
  EXPECT_EQ(rate_text(1, 1000), "0.01");
  EXPECT_EQ(rate_text(833, 1000), "0.83");
  EXPECT_EQ(rate_text(8449, 10000), "0.84");
  EXPECT_EQ(rate_text(8451, 10000), "0.85");
  EXPECT_EQ(rate_text(999, 1000), "0.99");
  EXPECT_EQ(rate_text(7, 7), "1.00");
}

TEST(Panels, HaveTheNamesAndKindsOfAny) {
  const HeatFigure figure = arrange({{"first", heat_table({{"e1", "x", 10, false}})},
                                     {"second", heat_table({{"e1", "y", 30, true}, {"e0", "x", 50, true}})}},
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
      arrange({{"", heat_table({{"e", "x", 60}, {"e", "y", 50}})}, {"", heat_table({{"e", "x", 20}, {"e", "y", 90}})}},
              grid_task_names(), HeatOrder::kMean);
  for (const HeatPanel& panel : figure.panels) EXPECT_EQ(panel.table.tasks, (Names{"y", "x"}));
}

TEST(Panels, TooManyNamesAreRefused) {
  std::vector<std::string> names;
  for (int i = 0; i < 100'001; ++i) names.push_back("e" + std::to_string(i));
  std::vector<HeatPair> pairs;
  for (const std::string& name : names) pairs.push_back({name.c_str(), "t", 1});
  EXPECT_THROW(heat_table(pairs), Error);
  pairs.resize(2001);
  EXPECT_THROW(arranged(heat_table(pairs), HeatOrder::kPaper, HeatOrder::kCluster), Error);
  EXPECT_NO_THROW(arranged(heat_table(pairs), HeatOrder::kCluster, HeatOrder::kMean));
}

TEST(Margins, MeansOfTheLineAndOfEachOfItsKinds) {
  const HeatTable one =
      arranged(heat_table({{"a", "x", 80, true}, {"b", "x", 20, false}, {"a", "y", 40, true}}), HeatOrder::kPaper)
          .panels[0]
          .table;
  const std::vector<HeatMargin> margins = margins_of(one);
  ASSERT_EQ(margins.size(), 3u);
  EXPECT_EQ(margins[0].name, "mean all");
  EXPECT_DOUBLE_EQ(margins[0].tasks[0].mean(), 0.5);
  EXPECT_DOUBLE_EQ(margins[0].envs[0].mean(), 0.6);
  EXPECT_EQ(margins[1].name, "mean seen");
  EXPECT_DOUBLE_EQ(margins[1].tasks[0].mean(), 0.8);
  EXPECT_EQ(margins[2].name, "mean unseen");
  EXPECT_DOUBLE_EQ(margins[2].envs[1].mean(), 0.2);
  EXPECT_FALSE(margins[2].tasks[1].evaluated());
  // One kind has no mean apart from that of all.
  EXPECT_EQ(margins_of(heat_table({{"a", "x", 80}})).size(), 1u);
}

TEST(Margins, EveryPairCountsAlikeWhateverItsEpisodes) {
  Matrix matrix;
  for (const int64_t episodes : {10, 90}) {
    const int64_t successes = episodes == 10 ? 10 : 45;
    matrix.rows.push_back(matrix_row("e" + std::to_string(episodes), "t", true, successes, episodes));
  }
  const HeatTable one = pool_matrix(matrix);
  EXPECT_DOUBLE_EQ(margins_of(one)[0].tasks[0].mean(), 0.75);
  EXPECT_DOUBLE_EQ(one.groups[0].mean(), 0.75);
  EXPECT_DOUBLE_EQ(one.groups[0].rate(), 0.55);
  EXPECT_EQ(rate_text(margins_of(one)[0].envs[0]), "1.00");
  EXPECT_EQ(rate_text(margins_of(one)[0].tasks[0]), "0.75");
}

}  // namespace
}  // namespace synpo
