#include "stats/matrix/merge.h"

#include <gtest/gtest.h>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Merge, AddsRowsThatFollowAndKeepsGaps) {
  const Matrix merged =
      merge_matrices({{"a", matrix({row("r1", "e", true, 10, 10, 5, 2, 0.1, 30), row("r1", "f", true, 0, 10, 9)})},
                      {"b", matrix({row("r1", "e", true, 0, 10, 7, 1, 0.2, 40), row("r1", "e", true, 30, 5, 1)})},
                      {"c", matrix({row("r2", "e", false, 0, 10, 3)})}});
  ASSERT_EQ(merged.rows.size(), 4u);
  EXPECT_EQ(merged.rows[0].first_episode, 0);
  EXPECT_EQ(merged.rows[0].episodes, 20);
  EXPECT_EQ(merged.rows[0].successes, 12);
  EXPECT_EQ(merged.rows[0].wrong, 3);
  EXPECT_EQ(merged.rows[0].timeouts, 5);
  EXPECT_EQ(merged.rows[0].length, 70);
  EXPECT_EQ(merged.rows[0].reward, 0.3) << "not 0.30000000000000004: shards merge exactly";
  EXPECT_EQ(merged.rows[1].first_episode, 30);
  EXPECT_EQ(merged.rows[2].env, "f");
  EXPECT_EQ(merged.rows[3].run, "r2");
}

TEST(Merge, RewardsAreAddedExactlyWhereTheyAreHundredths) {
  EXPECT_EQ(add_rewards(0.1, 0.2), 0.3);
  EXPECT_EQ(add_rewards(-0.1, -0.2), -0.3);
  EXPECT_EQ(add_rewards(0.125, 1), 1.125) << "no hundredths";
  EXPECT_EQ(add_rewards(1, 0.125), 1.125);
  EXPECT_EQ(add_rewards(1e14, 0.5), 1e14 + 0.5) << "too large to be counted in hundredths";
  EXPECT_EQ(add_rewards(0.5, -1e14), 0.5 - 1e14);
}

TEST(Merge, RefusesToCountTwice) {
  const MatrixSource a{"a.tsv", matrix({row("r1", "x", true, 0, 10, 5), row("r1", "e", true, 0, 100, 5)})};
  EXPECT_EQ(thrown([&] {
              merge_matrices({a, {"b.tsv", matrix({row("r1", "e", true, 99, 2, 1)})}});
            }),
            "65 a.tsv line 3 and b.tsv line 2 count episodes twice: episodes 0 to 99 and episodes 99 to 100 of pair "
            "'e', 'R-B', "
            "eval_seed 0, of the same run");
  EXPECT_EQ(thrown([&] { merge_matrices({a, a}); }).substr(0, 49), "65 a.tsv line 2 and a.tsv line 2 count episodes t");
  MatrixRow other = row("r1", "e", true, 0, 100, 5);
  other.eval_seed = 1;
  EXPECT_EQ(merge_matrices({a, {"b.tsv", matrix({other})}}).rows.size(), 3u) << "other episodes altogether";
  MatrixRow unnamed = row("x", "e", true, 0, 100, 5);
  unnamed.run = "";
  EXPECT_TRUE(thrown([&] {
                merge_matrices({{"a", matrix({unnamed})}, {"b", matrix({unnamed})}});
              }).ends_with("eval_seed 0 (no run is named: give different runs a column run or seed)"));
}

TEST(Merge, RefusesRunsThatDisagree) {
  const MatrixSource a{"a.tsv", matrix({row("r1", "e", true, 0, 10, 5)})};
  MatrixRow other = row("r1", "f", true, 0, 10, 5);
  other.method = "mlp";
  EXPECT_EQ(thrown([&] {
              merge_matrices({a, {"b.tsv", matrix({other})}});
            }),
            "65 b.tsv line 2: found method 'mlp', expected 'synpo' as in a.tsv line 2, a row of the same run");
  const auto disagrees = [&](auto MatrixRow::*member, auto value) {
    MatrixRow b = row("r1", "f", true, 0, 10, 5);
    b.*member = value;
    const std::string message = thrown([&] { merge_matrices({a, {"b.tsv", matrix({b})}}); });
    return message.substr(0, message.find(", expected"));
  };
  EXPECT_EQ(disagrees(&MatrixRow::world, "kitchen"), "65 b.tsv line 2: found world 'kitchen'");
  EXPECT_EQ(disagrees(&MatrixRow::window, 0), "65 b.tsv line 2: found window '0'");
  EXPECT_EQ(disagrees(&MatrixRow::seed, 77), "65 b.tsv line 2: found seed '77'");
  EXPECT_EQ(disagrees(&MatrixRow::updates, 77), "65 b.tsv line 2: found updates '77'");
  EXPECT_EQ(thrown([&] {
              merge_matrices({a, {"b.tsv", matrix({row("r1", "e", false, 10, 10, 5)})}});
            }),
            "65 b.tsv line 2: found seen '0', expected '1' as in a.tsv line 2, a row of the same run");
}

TEST(Merge, UnitesUnknownColumns) {
  Matrix a = matrix({row("r1", "e", true, 0, 10, 5), row("r1", "f", true, 0, 10, 5)});
  a.extra_columns = {"host", "note"};
  a.rows[0].extra = {"h1", "n"};
  a.rows[1].extra = {"h1", "n"};
  Matrix b = matrix({row("r1", "e", true, 10, 10, 5), row("r1", "f", true, 10, 10, 5)});
  b.extra_columns = {"note", "host", "more"};
  b.rows[0].extra = {"n", "h1", ""};
  b.rows[1].extra = {"n", "h1", "m"};
  const Matrix merged = merge_matrices({{"a", a}, {"b", b}});
  EXPECT_EQ(merged.extra_columns, (std::vector<std::string>{"host", "note", "more"}));
  ASSERT_EQ(merged.rows.size(), 3u) << "e added up, f's rows differ";
  EXPECT_EQ(merged.rows[0].extra, (std::vector<std::string>{"h1", "n", ""}));
  EXPECT_EQ(merged.rows[2].extra, (std::vector<std::string>{"h1", "n", "m"}));
}

TEST(Merge, PartsOfAnySourceAreKept) {
  Matrix a = matrix({row("r1", "e", true, 0, 10, 5)}), b = matrix({row("r1", "f", true, 0, 10, 5)});
  EXPECT_FALSE(merge_matrices({{"a", a}, {"b", b}}).has_part);
  b.has_part = true;
  b.rows[0].part = "Q";
  const Matrix merged = merge_matrices({{"a", a}, {"b", b}});
  EXPECT_TRUE(merged.has_part);
  EXPECT_EQ(merged.rows.at(1).part, "Q");
}

TEST(Merge, RunsOfOneTrainingAtOtherTemperaturesStayApart) {
  Matrix a = matrix({row("r1", "e", true, 0, 10, 5)}), b = a;
  a.rows[0].temperature = 0;
  b.rows[0].temperature = 1;
  EXPECT_EQ(merge_matrices({{"a", a}, {"b", b}}).rows.size(), 2u) << "the same episodes, counted once each";
  b.rows[0].first_episode = 10;
  EXPECT_EQ(merge_matrices({{"a", a}, {"b", b}}).rows.size(), 2u);
  b.rows[0].temperature = 0;
  EXPECT_EQ(merge_matrices({{"a", a}, {"b", b}}).rows.size(), 1u);
  b.rows[0].temperature = 1;
  b.rows[0].method = "mlp";
  EXPECT_TRUE(thrown([&] { merge_matrices({{"a", a}, {"b", b}}); }).starts_with("65 b line 2: found method 'mlp'"));
}

TEST(Merge, WhatOneSourceSaysOfAnEnvironmentOrPairHoldsForTheRun) {
  Matrix a = matrix({row("r1", "e", false, 0, 10, 5)}), b = matrix({row("r1", "e", false, 10, 10, 5)});
  b.rows[0].env_hash = "00000000000000aa";
  b.rows[0].is_new = true;
  for (const auto& sources : {std::vector<MatrixSource>{{"a", a}, {"b", b}}, {{"b", b}, {"a", a}}}) {
    const Matrix merged = merge_matrices(sources);
    ASSERT_EQ(merged.rows.size(), 1u);
    EXPECT_EQ(merged.rows[0].env_hash, "00000000000000aa");
    EXPECT_TRUE(merged.rows[0].is_new);
  }
  a.rows[0].env_hash = "00000000000000bb";
  EXPECT_EQ(thrown([&] {
              merge_matrices({{"a", a}, {"b", b}});
            }),
            "65 b line 2: found env_hash '00000000000000aa', expected '00000000000000bb' as in a line 2, a row of the "
            "same run");
}

TEST(Merge, SumsThatCouldNotBeReadAgainStayApart) {
  const int64_t half = kMatrixCount / 2;
  EXPECT_EQ(
      merge_matrices({{"a", matrix({row("r1", "e", true, 0, half, half), row("r1", "e", true, half, half, half)})}})
          .rows.size(),
      1u);
  EXPECT_EQ(
      merge_matrices({{"a", matrix({row("r1", "e", true, 0, half, half), row("r1", "e", true, half, half + 1, half)})}})
          .rows.size(),
      2u);
  EXPECT_EQ(merge_matrices(
                {{"a", matrix({row("r1", "e", true, 0, 1, 1, 0, 6e14, 1), row("r1", "e", true, 1, 1, 1, 0, 6e14, 1)})}})
                .rows.size(),
            2u);
}

TEST(Merge, KeepsRowsApartOfWhichOneSaysLess) {
  MatrixRow bare = row("r1", "e", true, 4, 4, 3);
  bare.timeouts = 0;
  EXPECT_EQ(merge_matrices({{"a", matrix({row("r1", "e", true, 0, 4, 3, 1, 2, 8), bare})}}).rows.size(), 2u);
  MatrixRow first = row("r1", "e", true, 0, 4, 4);  // of the same table, which has no column of failures
  const Matrix merged = merge_matrices({{"a", matrix({first, bare})}});
  ASSERT_EQ(merged.rows.size(), 1u);
  EXPECT_FALSE(merged.rows[0].knows_failures());
}

}  // namespace
}  // namespace synpo
