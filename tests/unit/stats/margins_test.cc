#include "stats/report/margins.h"

#include <gtest/gtest.h>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Margins, WorstFirst) {
  const Matrix m =
      matrix({row("r1", 1, "e", "t", true, 9), row("r1", 1, "e", "u", false, 1), row("r1", 1, "f", "t", true, 4),
              row("r1", 1, "f", "u", true, 10), row("r2", 2, "f", "t", true, 8)});
  const auto rows = margins(m, Axis::kTasks), cols = margins(m, Axis::kEnvs);
  ASSERT_EQ(rows.at(0).margins.size(), 2u);
  const Margin& worst = rows[0].margins[0];
  EXPECT_EQ(worst.name, "u");
  EXPECT_EQ(worst.pairs, 2);
  EXPECT_DOUBLE_EQ(worst.rate(), 11.0 / 20);
  EXPECT_EQ(worst.seen.successes, 10);
  EXPECT_EQ(worst.unseen.successes, 1);
  EXPECT_EQ(worst.worst, "e");
  EXPECT_DOUBLE_EQ(rows[0].margins[1].rate(), 21.0 / 30);
  EXPECT_EQ(rows[0].margins[1].worst, "f") << "12 of 20 over both runs, against 9 of 10";
  EXPECT_EQ(cols[0].margins[0].name, "e");
  EXPECT_EQ(cols[0].margins[0].worst, "u");
  EXPECT_EQ(margins_text(rows, Axis::kTasks, 1).find("21 of 30"), std::string::npos);
  const std::string tsv = written([&](Output& output) { write_margins(output, cols, Axis::kEnvs, 1); });
  EXPECT_NE(tsv.find("gridworld\t1\tsynpo\te\t2\t2\t20\t10\t0.5\t"), std::string::npos) << tsv;
  EXPECT_NE(tsv.find("\t0.9\t0.1\tNA\tNA\tu\t0.1\tNA\tNA\n"), std::string::npos) << tsv;
}

TEST(Margins, NewPairsHaveARateOfTheirOwn) {
  Matrix m =
      matrix({row("r1", 1, "e", "t", true, 9), row("r1", 1, "f", "t", false, 5), row("r1", 1, "g", "t", false, 1)});
  m.rows[2].is_new = true;
  const auto rows = margins(m, Axis::kTasks);
  EXPECT_EQ(rows[0].margins[0].unseen.successes, 5);
  EXPECT_EQ(rows[0].margins[0].new_pairs.successes, 1);
  EXPECT_NE(margins_text(rows, Axis::kTasks, 9).find("seen %  unseen %  new %\n"), std::string::npos);
  EXPECT_NE(margins_text(rows, Axis::kTasks, 9).find("90.0      50.0   10.0\n"), std::string::npos);
  m.rows[0].env_hash = "1";
  m.rows.push_back(row("r2", 2, "e", "t", true, 9));
  m.rows[3].env_hash = "2";
  EXPECT_TRUE(
      thrown([&] { margins(m, Axis::kEnvs); }).starts_with("65 the environment 'e' is not the same in all rows"));
}

}  // namespace
}  // namespace synpo
