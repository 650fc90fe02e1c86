#include "stats/report/method_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"
#include "stats/bootstrap.h"
#include "stats/report/margins.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

const MeasureKind& success() { return find_measure("success"); }

TEST(MethodTable, HandComputed) {
  const Matrix m =
      matrix({row("r1", 1, "e", "t", true, 10), row("r1", 1, "f", "t", true, 5), row("r2", 2, "e", "t", true, 8),
              row("r2", 2, "f", "t", true, 6), row("m1", 1, "e", "t", true, 3, 10, "mlp")});
  const MethodTable table = tabulate(m, {"seen", "unseen"}, success(), {});
  ASSERT_EQ(table.lines.size(), 2u);
  const TableCell& cell = table.lines[0].cells[0];
  EXPECT_EQ(cell.runs, 2);
  EXPECT_EQ(cell.pairs, 2);
  EXPECT_EQ(cell.episodes, 40);
  EXPECT_DOUBLE_EQ(cell.over_runs.mean, 0.725);  // of 0.75 and 0.7
  EXPECT_NEAR(cell.over_runs.sd, 0.05 / std::sqrt(2.0), 1e-15);
  EXPECT_DOUBLE_EQ(cell.iqm, 0.7);                                   // of 0.6 and 0.8
  EXPECT_NEAR(cell.interval.low, 0.725 - 12.7062047 * 0.025, 1e-8);  // Student's, one degree of freedom
  EXPECT_EQ(cell.interval.high, 1) << "no rate is above";
  EXPECT_FALSE(cell.wilson);
  EXPECT_TRUE(std::isnan(table.lines[0].cells[1].over_runs.mean));
  EXPECT_TRUE(std::isnan(table.lines[0].cells[1].interval.low));
  EXPECT_EQ(table.lines[1].label, "mlp");
  EXPECT_TRUE(table.lines[1].cells[0].wilson);
  EXPECT_DOUBLE_EQ(table.lines[1].cells[0].interval.low, wilson(3, 10).low);
  const std::string text = method_table_text(table, TableFormat::kText, false);
  EXPECT_TRUE(
      text.starts_with("method  runs       seen %   95 % interval   IQM  unseen %  95 % interval  IQM\n"
                       "synpo      2  72.5 +- 3.5    40.7 to 99.9  70.0         -              -    -\n"
                       "mlp        1         30.0  10.8 to 60.3 w  30.0         -              -    -\n"))
      << text;
  EXPECT_EQ(method_table_text(table, TableFormat::kText, true).find("IQM"), std::string::npos);
  EXPECT_EQ(method_table_text(table, TableFormat::kLatex, true).substr(0, 2), "% ");
  const std::string tsv = written([&](Output& output) { write_method_table(output, table); });
  EXPECT_NE(tsv.find("gridworld\t1\tmlp\tseen\tsuccess\t1\t1\t10\t0.3\tNA\t0.3\t0.107"), std::string::npos) << tsv;
  EXPECT_NE(tsv.find("gridworld\t1\tmlp\tunseen\tsuccess\t0\t0\t0\tNA\tNA\tNA\tNA\tNA\tNA\tNA\n"), std::string::npos)
      << tsv;
}

// Episodes differ in number: every pair counts alike, as the text says.
TEST(MethodTable, PairsCountAlike) {
  const Matrix m = matrix({row("r1", 1, "e", "t", true, 90, 100), row("r1", 1, "f", "t", true, 1, 10)});
  const TableCell cell = tabulate(m, {"seen"}, success(), {}).lines[0].cells[0];
  EXPECT_DOUBLE_EQ(cell.over_runs.mean, 0.5);
  EXPECT_TRUE(std::isnan(cell.interval.low)) << "Wilson's, of 91 in 110, is not about this mean";
  EXPECT_FALSE(cell.wilson);
}

// Two runs of 360 and 361 in 400: Student's is 0.9 +- 12.7 * 0.00125, within Wilson's of 721 in 800, which is worked
// out apart: 0.878620 to 0.920045.
TEST(MethodTable, NeverNarrowerThanTheEpisodesAllow) {
  const TableCell cell =
      tabulate(matrix({row("r1", 1, "e", "t", true, 360, 400), row("r2", 2, "e", "t", true, 361, 400)}), {"seen"},
               success())
          .lines[0]
          .cells[0];
  EXPECT_TRUE(cell.wilson);
  EXPECT_NEAR(cell.interval.low, 0.878620, 1e-6);
  EXPECT_NEAR(cell.interval.high, 0.920045, 1e-6);
}

TEST(MethodTable, TheOrderOfTheRowsDoesNotCount) {
  std::vector<MatrixRow> rows;
  for (uint64_t seed = 1; seed <= 3; ++seed)
    for (int e = 0; e < 7; ++e)
      rows.push_back(
          row("r" + std::to_string(seed), seed, "e" + std::to_string(e), "t", true, (seed * 5 + e * 3) % 11, 13));
  const auto ends = [&](const std::optional<BootstrapPlan>& bootstrap) {
    const TableCell cell = tabulate(matrix(rows), {"seen"}, success(), bootstrap).lines[0].cells[0];
    return std::tuple(cell.over_runs.mean, cell.over_runs.sd, cell.interval.low, cell.interval.high, cell.iqm);
  };
  const auto given = ends({}), drawn = ends(BootstrapPlan{});
  std::reverse(rows.begin(), rows.end());
  EXPECT_EQ(ends({}), given);
  EXPECT_EQ(ends(BootstrapPlan{}), drawn);
}

TEST(MethodTable, OnlyABootstrapOfFewRunsIsTooNarrow) {
  std::vector<MatrixRow> rows = {row("m", 1, "e", "t", true, 5, 10, "mlp")};
  for (uint64_t seed = 1; seed <= 12; ++seed)
    rows.push_back(row("r" + std::to_string(seed), seed, "e", "t", true, 300 + 100 * (seed % 4), 1000));
  const auto warns = [&] {
    return method_table_text(tabulate(matrix(rows), {"seen"}, success(), BootstrapPlan{}), TableFormat::kText, false)
               .find("too narrow") != std::string::npos;
  };
  EXPECT_FALSE(warns()) << "twelve runs, and one with Wilson's";
  std::swap(rows.front(), rows.back());
  EXPECT_FALSE(warns());
  rows.resize(8);
  EXPECT_TRUE(warns());
}

TEST(MethodTable, RunsWithoutAFailure) {
  std::vector<MatrixRow> rows;
  for (uint64_t seed : {1, 2, 3}) rows.push_back(row("r" + std::to_string(seed), seed, "e", "t", true, 10));
  const std::string text =
      method_table_text(tabulate(matrix(rows), {"seen"}, success(), {}), TableFormat::kText, false);
  EXPECT_NE(text.find("100.0 (3 alike)  88.6 to 100.0 w  100.0"), std::string::npos) << text;
}

TEST(MethodTable, LabelsTellWorldsAndWindowsApart) {
  Matrix m = matrix(
      {row("r1", 1, "e", "t", true, 5), row("r2", 1, "e", "t", true, 5), row("r3", 1, "e", "t", true, 5, 10, "mlp")});
  m.rows[1].window = 2;
  const MethodTable table = tabulate(m, {"seen"}, success(), {});
  EXPECT_EQ(table.lines[0].label, "synpo, window 1");
  EXPECT_EQ(table.lines[1].label, "synpo, window 2");
  EXPECT_EQ(table.lines[2].label, "mlp");
}

TEST(MethodTable, TemperaturesAreLinesOfTheirOwn) {
  Matrix m =
      matrix({row("r1", 1, "e", "t", true, 5), row("r1", 1, "e", "t", true, 7), row("r2", 2, "e", "t", true, 9)});
  m.rows[0].temperature = 0;
  m.rows[1].temperature = m.rows[2].temperature = 0.5;
  const MethodTable table = tabulate(m, {"seen"}, success());
  ASSERT_EQ(table.lines.size(), 2u);
  EXPECT_EQ(table.lines[0].label, "synpo, temperature 0");
  EXPECT_EQ(table.lines[0].cells[0].runs, 1);
  EXPECT_EQ(table.lines[1].label, "synpo, temperature 0.5");
  EXPECT_DOUBLE_EQ(table.lines[1].cells[0].over_runs.mean, 0.8);
}

}  // namespace
}  // namespace synpo
