#include "stats/report/compare.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Compare, HandComputed) {
  const MatrixSource a{"a", matrix({row("a", 1, "e", "t", true, 50, 100), row("a", 1, "f", "t", false, 20, 100),
                                    row("a", 1, "g", "t", true, 10, 100), row("a", 1, "h", "t", true, 1, 100),
                                    row("a", 1, "i", "t", true, 1, 100)})};
  const MatrixSource b{
      "b", matrix({row("b", 1, "e", "t", true, 60, 100, "mlp"), row("b", 1, "f", "t", false, 70, 100, "mlp"),
                   row("b", 1, "g", "t", true, 10, 50, "mlp"), row("b", 1, "h", "t", false, 9, 100, "mlp")})};
  const Comparison c = compare(a, b, false);
  EXPECT_TRUE(c.matched);
  EXPECT_EQ(c.other_starts.pairs, 1) << "g: 100 episodes and 50";
  EXPECT_EQ(c.other_seen.pairs, 1) << "h";
  EXPECT_EQ(c.only_one.pairs, 1) << "i";
  ASSERT_EQ(c.subsets.size(), 3u);
  EXPECT_EQ(c.subsets[2].name, "all");
  EXPECT_EQ(c.subsets[2].pairs, 2);
  EXPECT_EQ(c.subsets[2].better, 2);
  EXPECT_DOUBLE_EQ(c.subsets[2].mean_a, 0.35);
  EXPECT_DOUBLE_EQ(c.subsets[2].mean_b, 0.65);
  EXPECT_NEAR(c.subsets[2].change, 0.3, 1e-12);
  // Changes of 0.1 and 0.5 in two environments: 0.3 +- 12.7 * 0.2.
  EXPECT_EQ(c.subsets[2].interval.low, -1);
  EXPECT_EQ(c.subsets[2].interval.high, 1);
  EXPECT_DOUBLE_EQ(c.subsets[0].interval.low, newcombe(60, 100, 50, 100).low) << "one pair and one run each";
  EXPECT_EQ(c.pairs.at(0).env, "f");
  EXPECT_DOUBLE_EQ(c.pairs[0].change(), 0.5);
  EXPECT_DOUBLE_EQ(c.pairs[0].interval.low, newcombe(70, 100, 20, 100).low);
  const std::string text = comparison_text(c, 1);
  EXPECT_NE(text.find("f    t     unseen  20 of 100  70 of 100  +50.0  +36.9 to +60.5\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Left out: 1 pair that only one of the two has; 1 pair seen by one and unseen by the other; 1 "
                      "pair without common"),
            std::string::npos)
      << text;
  EXPECT_EQ(compare(a, b, true).subsets.back().pairs, 3);
}

TEST(Compare, RunsOfOneSeedBelongTogetherInAnyOrder) {
  // Seed by seed B is better by 0.1, and the seeds differ by 0.5.
  const MatrixSource a{"a", matrix({row("a1", 1, "e", "t", true, 2), row("a2", 2, "e", "t", true, 7)})};
  const MatrixSource b{"b", matrix({row("b2", 2, "e", "t", true, 8), row("b1", 1, "e", "t", true, 3)})};
  EXPECT_NEAR(compare(a, b, false).subsets[0].interval.low, newcombe(11, 20, 9, 20).low, 1e-12);
  MatrixSource other = b;
  other.matrix.rows[0].seed = 3;
  const Comparison apart = compare(a, other, false);
  EXPECT_FALSE(apart.matched);
  EXPECT_EQ(apart.subsets[0].interval.low, -1) << "two degrees of freedom: 0.1 +- 4.3 * sqrt(0.125)";
  EXPECT_EQ(apart.subsets[0].interval.high, 1);
}

// Four environments, three tasks, 1,000 episodes a pair; side 0 or 1, and a run's number, which is its seed.
std::vector<MatrixRow> made_up(int side, const std::vector<int>& runs) {
  std::vector<MatrixRow> rows;
  for (const int r : runs)
    for (int e = 0; e < 4; ++e)
      for (int t = 0; t < 3; ++t)
        rows.push_back(row(concat(side, ' ', r), uint64_t(r), concat('e', e), concat('t', t), true,
                           900 + side * 20 + r * r * 3 - r * 7 * side + e * 4 * (1 + side) - t * 6 + e * t * 5 % 7,
                           1000));
  return rows;
}

// By a program of its own.
TEST(Compare, IntervalsOfFewRuns) {
  const struct {
    std::vector<int> a, b;
    double change, low, high;
  } cases[] = {{{1, 2, 3}, {4, 5}, 0.042, -0.0116100616, 0.0956100616},
               {{1, 2, 3}, {1, 2, 3}, 0.012, -0.0072326761, 0.0312326761},
               {{1}, {4, 5, 6}, 0.065, -0.0498881214, 0.1798881214},
               {{1, 2}, {4}, 0.0385, -0.0608753683, 0.1378753683},
               {{1}, {1}, 0.019, 0.0107829590, 0.0272170410}};
  for (const auto& one : cases) {
    const Comparison c = compare({"a", matrix(made_up(0, one.a))}, {"b", matrix(made_up(1, one.b))}, false);
    EXPECT_NEAR(c.subsets[0].change, one.change, 1e-12);
    EXPECT_NEAR(c.subsets[0].interval.low, one.low, 1e-9);
    EXPECT_NEAR(c.subsets[0].interval.high, one.high, 1e-9);
  }
}

TEST(Compare, NeitherRowsNorRunsCountByTheirOrder) {
  std::vector<MatrixRow> a = made_up(0, {1, 2, 3}), b = made_up(1, {3, 4, 5, 6});
  for (const bool matched : {false, true}) {
    if (matched) b = made_up(1, {1, 2, 3});
    const Interval given = compare({"a", matrix(a)}, {"b", matrix(b)}, false).subsets.back().interval;
    std::vector<MatrixRow> turned = a, other = b;
    std::reverse(turned.begin(), turned.end());
    std::rotate(other.begin(), other.begin() + 17, other.end());
    const Interval again = compare({"a", matrix(turned)}, {"b", matrix(other)}, false).subsets.back().interval;
    EXPECT_EQ(given.low, again.low);
    EXPECT_EQ(given.high, again.high);
  }
}

// Two runs of other splits on each side: e is seen by the first and unseen by the second, f the other way round.
TEST(Compare, RunsOfOtherSplitsCountAPairOnce) {
  const auto side = [](const std::string& name, int64_t more) {
    return MatrixSource{name,
                        matrix({row(name + "1", 1, "e", "t", true, 6 + more), row(name + "1", 1, "f", "t", false, 4),
                                row(name + "2", 2, "e", "t", false, 2 + more), row(name + "2", 2, "f", "t", true, 8)})};
  };
  const Comparison c = compare(side("a", 0), side("b", 2), false);
  ASSERT_EQ(c.subsets.size(), 3u);
  const SubsetChange &seen = c.subsets[0], &unseen = c.subsets[1], &all = c.subsets[2];
  EXPECT_EQ(seen.pairs, 2);
  EXPECT_DOUBLE_EQ(seen.mean_a, 0.7);    // 6 of 10 and 8 of 10
  EXPECT_DOUBLE_EQ(unseen.mean_b, 0.4);  // 4 of 10 both
  EXPECT_EQ(all.pairs, 2) << "not four";
  EXPECT_EQ(all.better, 1);
  EXPECT_EQ(all.alike, 1);
  EXPECT_EQ(all.n_a, 40);
  EXPECT_DOUBLE_EQ(all.mean_a, 0.5);
  EXPECT_DOUBLE_EQ(all.mean_b, 0.6);
  ASSERT_EQ(c.pairs.size(), 2u);
  EXPECT_EQ(c.pairs[0].k_b, 12);
  EXPECT_FALSE(c.pairs[0].standing) << "seen by some runs and not by others";
  const std::string text = comparison_text(c, 1);
  EXPECT_NE(text.find("Changed most, of 2 pairs:\n"), std::string::npos) << text;
  EXPECT_NE(text.find("e    t     mixed  8 of 20  12 of 20"), std::string::npos) << text;
}

TEST(Compare, CountsRowsOfPairsThatStay) {
  MatrixSource a{"a", matrix({row("a1", 1, "e", "t", true, 6), row("a2", 2, "e", "t", false, 6)})};
  const MatrixSource b{"b", matrix({row("b1", 1, "e", "t", true, 6), row("b3", 3, "e", "t", true, 6)})};
  const Comparison c = compare(a, b, false);
  EXPECT_EQ(c.other_seen.pairs, 0);
  EXPECT_EQ(c.other_seen.rows, 1);
  EXPECT_EQ(c.lost_runs, 1);
  EXPECT_NE(
      comparison_text(c, 0).find("Left out: 1 row of other pairs seen by one and unseen by the other; 1 run that"),
      std::string::npos)
      << comparison_text(c, 0);
  a.matrix.rows[1].seen = true;
  a.matrix.rows[1].first_episode = 5;
  EXPECT_EQ(compare(a, b, false).other_starts.rows, 1);
}

TEST(Compare, OtherEnvironmentsOfTheSameNameAreLeftOut) {
  MatrixSource a{"a", matrix({row("a", 1, "e", "t", true, 6), row("a", 1, "f", "t", true, 6)})};
  MatrixSource b{"b", matrix({row("b", 1, "e", "t", true, 6), row("b", 1, "f", "t", true, 6)})};
  a.matrix.rows[0].env_hash = "0000000000000001";
  b.matrix.rows[0].env_hash = "0000000000000002";
  b.matrix.rows[1].env_hash = "0000000000000003";  // A does not say which f it is
  const Comparison c = compare(a, b, true);
  EXPECT_EQ(c.other_env.pairs, 1);
  EXPECT_EQ(c.pairs.size(), 1u);
  EXPECT_NE(comparison_text(c, 0).find("1 pair of another environment that goes by the same name"), std::string::npos);
  a.matrix.rows.resize(1);
  EXPECT_TRUE(thrown([&] { compare(a, b, true); }).starts_with("65 a and b: other environments go by the same names"));
  b.matrix.rows[1].env = "e";
  EXPECT_TRUE(
      thrown([&] { compare(a, b, true); }).starts_with("65 b: the environment 'e' is not the same in all rows"));
}

TEST(Compare, NamesTheTemperatures) {
  MatrixSource a{"a", matrix({row("r", 1, "e", "t", true, 6)})}, b{"b", matrix({row("r", 1, "e", "t", true, 7)})};
  a.matrix.rows[0].temperature = 0;
  b.matrix.rows[0].temperature = 0.5;
  const std::string text = comparison_text(compare(a, b, false), 0);
  EXPECT_NE(text.find("window 1, temperature 0: 1 run"), std::string::npos) << text;
  EXPECT_NE(text.find("Actions were drawn at temperature 0 in A, 0.5 in B.\n"), std::string::npos) << text;
  a.matrix.rows.push_back(b.matrix.rows[0]);
  EXPECT_TRUE(thrown([&] { compare(a, b, false); }).starts_with("65 a: rows of several temperatures: choose"));
}

// 400 pairs of 9 in 10 episodes on both sides: none leaves out 0, and by chance 0.9 % of them would.
TEST(Compare, SaysHowManyChanceAloneWouldMake) {
  std::vector<MatrixRow> a, b;
  for (int e = 0; e < 400; ++e) {
    a.push_back(row("a", 1, concat('e', e), "t", true, 9));
    b.push_back(row("b", 1, concat('e', e), "t", true, 9));
  }
  const std::string text = comparison_text(compare({"a", matrix(a)}, {"b", matrix(b)}, false), 1);
  EXPECT_NE(text.find("0 of 400 leave out 0; by chance alone it would be about 3.6,"), std::string::npos) << text;
}

TEST(Compare, RowsThatDoNotSayTheirEnvironmentAreOfTheOneThatOthersSay) {
  MatrixSource a{"a", matrix({row("a1", 1, "e", "t", true, 5), row("a1", 1, "f", "t", true, 5),
                              row("a2", 2, "e", "t", true, 6), row("a2", 2, "f", "t", true, 6)})};
  MatrixSource b = a;
  for (MatrixRow& row : a.matrix.rows)
    if (row.seed == 1) row.env_hash = row.env == "e" ? "0000000000000001" : "0000000000000002";
  for (MatrixRow& row : b.matrix.rows) row.env_hash = row.env == "e" ? "0000000000000003" : "0000000000000002";
  for (const Comparison& c : {compare(a, b, false), compare(b, a, false)}) {
    ASSERT_EQ(c.pairs.size(), 1u);
    EXPECT_EQ(c.pairs[0].env, "f");
    EXPECT_EQ(c.pairs[0].n_a, c.pairs[0].n_b);
    EXPECT_EQ(c.other_env.pairs, 1);
    EXPECT_EQ(c.other_env.rows, 0);
  }
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const MatrixSource a{"a.tsv", matrix({row("a", 1, "e", "t", true, 5)})};
  MatrixSource b = a;
  b.name = "b.tsv";
  b.matrix.rows[0].world = "kitchen";
  EXPECT_EQ(thrown([&] { compare(a, b, false); }), "65 b.tsv: found world 'kitchen', expected 'gridworld' as in a.tsv");
  b.matrix.rows = {row("a", 1, "e", "t", true, 5), row("m", 1, "e", "t", true, 5, 10, "mlp")};
  EXPECT_EQ(
      thrown([&] { compare(a, b, false); }),
      "65 b.tsv: rows of several methods, worlds or windows: choose with synpo-matrix filter what is to be compared");
  b.matrix.rows = {row("b", 1, "e", "t", true, 5)};
  b.matrix.rows[0].eval_seed = 9;
  EXPECT_EQ(thrown([&] { compare(a, b, false); }),
            "65 a.tsv and b.tsv have no pair with the same start states (eval_seed, first_episode, episodes) and the "
            "same seen");
  EXPECT_TRUE(fails_for(kOtherStarts, [&] { compare(a, b, false); }));
  EXPECT_EQ(thrown([&] { compare(a, b, true); }), "nothing thrown");
  MatrixSource in_p = a;
  in_p.matrix.rows[0].part = "P";
  b.matrix.rows[0].part = "Q";
  EXPECT_EQ(thrown([&] { compare(in_p, b, true); }), "65 a.tsv and b.tsv: pair 'e', 't' is in part 'P' and in 'Q'");
  for (const auto& [one, other] : {std::pair(a, in_p), std::pair(in_p, a)}) {
    const Comparison c = compare(one, other, true);
    EXPECT_EQ(c.subsets.back().name, "P") << "the part that one side has";
  }
}

}  // namespace
}  // namespace synpo
