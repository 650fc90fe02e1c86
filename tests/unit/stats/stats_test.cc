#include <cmath>

#include "helpers/table_helpers.h"
#include "stats/interval.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/runs.h"
#include "stats/report/summary.h"

namespace synpo {
namespace {

TEST(Wilson, HandComputed) {
  // p = 1/4, z^2/n = 1: (1/4 + 1/2 +- 2 sqrt(3/64 + 4/64)) / 2 = (3/4 +- sqrt(7)/4) / 2.
  const Interval quarter = wilson(1, 4, 2);
  EXPECT_NEAR(quarter.low, (3 - std::sqrt(7.0)) / 8, 1e-15);
  EXPECT_NEAR(quarter.high, (3 + std::sqrt(7.0)) / 8, 1e-15);
  // k = 0 gives z^2 / (n + z^2) above: 3.841458821 / 13.841458821.
  EXPECT_EQ(wilson(0, 10).low, 0);
  EXPECT_NEAR(wilson(0, 10).high, 0.2775327999, 1e-9);
  EXPECT_NEAR(wilson(10, 10).low, 1 - 0.2775327999, 1e-9);
  EXPECT_EQ(wilson(10, 10).high, 1);
  // 8 of 10, as tables have it.
  EXPECT_NEAR(wilson(8, 10).low, 0.490162, 1e-6);
  EXPECT_NEAR(wilson(8, 10).high, 0.943318, 1e-6);
  EXPECT_EQ(wilson(0, 0).low, 0);
  EXPECT_EQ(wilson(0, 0).high, 1);
}

TEST(Wilson, HoldsTheRateAndMirrors) {
  for (int64_t n : {1, 7, 100, 100000}) {
    for (int64_t k = 0; k <= n; k += std::max<int64_t>(1, n / 7)) {
      const Interval interval = wilson(k, n), mirror = wilson(n - k, n);
      EXPECT_LE(interval.low, double(k) / double(n));
      EXPECT_GE(interval.high, double(k) / double(n));
      EXPECT_LT(interval.low, interval.high);
      EXPECT_NEAR(interval.low, 1 - mirror.high, 1e-12);
    }
  }
}

TEST(MeanSd, DividesByOneLess) {
  const MeanSd eight = mean_sd({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(eight.count, 8);
  EXPECT_EQ(eight.mean, 5);
  EXPECT_NEAR(eight.sd, std::sqrt(32.0 / 7), 1e-15);
  EXPECT_EQ(mean_sd({3}).mean, 3);
  EXPECT_TRUE(std::isnan(mean_sd({3}).sd));
  EXPECT_TRUE(std::isnan(mean_sd({}).mean));
}

MatrixRow row(const std::string& run, const std::string& env, bool seen, int64_t first, int64_t episodes,
              int64_t successes, int64_t wrong = 0, double reward = 0, int64_t length = 0) {
  MatrixRow r;
  r.run = run;
  r.world = "gridworld";
  r.method = "synpo";
  r.seed = uint64_t(run.back());
  r.env = env;
  r.task = "R-B";
  r.seen = seen;
  r.first_episode = first;
  r.episodes = episodes;
  r.successes = successes;
  r.wrong = wrong;
  r.timeouts = episodes - successes - wrong;
  r.reward = reward;
  r.length = length;
  return r;
}

Matrix matrix(std::vector<MatrixRow> rows) {
  Matrix m;
  m.rows = std::move(rows);
  return m;
}

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

TEST(Summary, OneRun) {
  const auto groups =
      summarise(matrix({row("r1", "e", true, 0, 10, 8, 1, 80, 300), row("r1", "f", true, 0, 30, 12, 3, 100, 700),
                        row("r1", "g", false, 0, 10, 1, 9, -80, 100)}));
  ASSERT_EQ(groups.size(), 1u);
  const SubsetSummary& seen = groups[0].subsets.at(0);
  EXPECT_EQ(seen.name, "seen");
  EXPECT_EQ(seen.pairs, 2);
  EXPECT_EQ(seen.episodes, 40);
  EXPECT_EQ(seen.successes, 20);
  EXPECT_DOUBLE_EQ(seen.success.pooled, 0.5);
  EXPECT_DOUBLE_EQ(seen.pair_mean, 0.6);  // (0.8 + 0.4) / 2
  EXPECT_DOUBLE_EQ(seen.interval.low, wilson(20, 40).low);
  EXPECT_DOUBLE_EQ(seen.reward.pooled, 4.5);
  EXPECT_DOUBLE_EQ(seen.length.pooled, 25);
  EXPECT_DOUBLE_EQ(seen.wrong.pooled, 0.1);
  EXPECT_DOUBLE_EQ(seen.timeouts.pooled, 0.4);
  EXPECT_TRUE(std::isnan(seen.success.over_runs.sd));
  EXPECT_EQ(groups[0].subsets.at(1).successes, 1);
  EXPECT_EQ(groups[0].subsets.at(2).episodes, 50);
  EXPECT_EQ(groups[0].subsets.size(), 3u);
  EXPECT_EQ(summary_text(groups).find("+-"), std::string::npos) << "one run has no spread";
}

TEST(Summary, SeveralRuns) {
  const auto groups =
      summarise(matrix({row("r1", "e", true, 0, 10, 8, 2, 1, 1), row("r2", "e", true, 0, 10, 6, 4, 1, 1),
                        row("r3", "e", true, 0, 20, 8, 12, 1, 1)}));
  const SubsetSummary& seen = groups.at(0).subsets.at(0);
  EXPECT_EQ(seen.runs, 3);
  EXPECT_EQ(seen.pairs, 1);
  EXPECT_DOUBLE_EQ(seen.success.pooled, 0.55);         // 22 of 40
  EXPECT_DOUBLE_EQ(seen.success.over_runs.mean, 0.6);  // of 0.8, 0.6, 0.4
  EXPECT_DOUBLE_EQ(seen.success.over_runs.sd, 0.2);
  EXPECT_TRUE(std::isnan(groups[0].subsets.at(1).success.pooled));
  EXPECT_TRUE(groups[0].notes.empty());
  const std::string text = summary_text(groups);
  EXPECT_NE(text.find("60.0 +- 20.0"), std::string::npos) << text;
  EXPECT_NE(text.find("divisor: runs - 1"), std::string::npos);
}

TEST(Summary, KeepsMethodsApartAndTakesParts) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8), row("r2", "e", true, 0, 10, 6), row("r1", "f", true, 0, 10, 4)});
  m.rows[1].method = "mlp";
  m.has_part = true;
  m.rows[0].part = "P";
  m.rows[2].part = "Q";
  const auto groups = summarise(m);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[1].method, "mlp");
  ASSERT_EQ(groups[0].subsets.size(), 6u);
  EXPECT_EQ(groups[0].subsets[3].name, "P");
  EXPECT_EQ(groups[0].subsets[3].successes, 8);
  EXPECT_EQ(groups[0].subsets[4].successes, 4);
  EXPECT_EQ(groups[0].subsets[5].pairs, 0);
}

TEST(Summary, SaysWhatIsOddAboutTheRuns) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8), row("r2", "e", false, 0, 10, 6)});
  m.rows[1].seed = m.rows[0].seed;
  const auto notes = summarise(m).at(0).notes;
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "'synpo': several runs name the same seed, so their sd is not one over seeds");
  EXPECT_EQ(notes[1], "'synpo': the runs differ in their pairs, or in which of them are seen");
}

TEST(Summary, LeavesOutWhatAHandMadeMatrixDoesNotSay) {
  MatrixRow bare;
  bare.env = "e";
  bare.task = "t";
  bare.episodes = 4;
  bare.successes = 3;
  const SubsetSummary all = summarise(matrix({bare})).at(0).subsets.at(2);
  EXPECT_DOUBLE_EQ(all.success.pooled, 0.75);
  for (const Measure* measure : {&all.reward, &all.length, &all.wrong, &all.timeouts})
    EXPECT_TRUE(std::isnan(measure->pooled));
}

TEST(Summary, WhatSomeRowsDoNotSayIsNotKnownOfAll) {
  MatrixRow bare = row("r2", "e", true, 0, 4, 3);
  bare.timeouts = 0;
  const Matrix m = matrix({row("r1", "e", true, 0, 4, 3, 1, 2, 8), bare});
  Tally tally;
  for (const MatrixRow& one : m.rows) tally.add(one);
  EXPECT_DOUBLE_EQ(find_measure("success").value(tally), 0.75);
  for (const char* name : {"reward", "length", "wrong", "timeouts"})
    EXPECT_TRUE(std::isnan(find_measure(name).value(tally))) << name;
  const SubsetSummary all = summarise(m).at(0).subsets.at(2);
  for (const Measure* measure : {&all.reward, &all.length, &all.wrong, &all.timeouts})
    EXPECT_TRUE(std::isnan(measure->pooled));
}

// A table with lengths and without rewards: none was counted, and 0 would be a number.
TEST(Summary, NoRewardIsNotARewardOfZero) {
  MatrixRow silent = row("r1", "e", true, 0, 4, 3, 1, NAN, 80);
  const SubsetSummary all = summarise(matrix({silent})).at(0).subsets.at(2);
  EXPECT_TRUE(std::isnan(all.reward.pooled));
  EXPECT_DOUBLE_EQ(all.length.pooled, 20);
  silent.reward = 0;
  EXPECT_EQ(summarise(matrix({silent})).at(0).subsets.at(2).reward.pooled, 0) << "earned, and as much lost";
}

TEST(Summary, PartsThatNoRowNamesAreNotListed) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8)});
  m.has_part = true;
  EXPECT_EQ(summarise(m).at(0).subsets.size(), 3u);
}

TEST(Summary, NewPairsAreNotUnseenOnes) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8), row("r1", "f", false, 0, 10, 6), row("r1", "g", false, 0, 10, 1)});
  m.rows[2].is_new = true;
  const auto& subsets = summarise(m).at(0).subsets;
  ASSERT_EQ(subsets.size(), 4u);
  EXPECT_EQ(subsets[1].name, "unseen");
  EXPECT_EQ(subsets[1].successes, 6);
  EXPECT_EQ(subsets[2].name, "new");
  EXPECT_EQ(subsets[2].successes, 1);
  EXPECT_EQ(subsets[3].successes, 15);
}

TEST(Summary, TemperaturesAreNotPooled) {
  Matrix m = matrix({row("r1", "e", true, 0, 7, 5), row("r1", "e", true, 7, 5, 2)});
  m.rows[0].temperature = 0;
  m.rows[1].temperature = 1;
  const auto groups = summarise(merge_matrices({{"a", m}}));
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].heading, "synpo on gridworld, window 1, temperature 0: 1 run (seed 49)");
  EXPECT_EQ(groups[0].subsets[0].successes, 5);
  EXPECT_EQ(groups[1].subsets[0].successes, 2);
}

TEST(Summary, NotesOtherEnvironmentsOfTheSameName) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8), row("r2", "e", true, 0, 10, 8)});
  m.rows[0].env_hash = "0000000000000001";
  EXPECT_TRUE(summarise(m).at(0).notes.empty());
  m.rows[1].env_hash = "0000000000000002";
  const auto notes = summarise(m).at(0).notes;
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0], "the environment 'e' is not the same in all runs (env_hash): other ones go by its name");
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

TEST(Summary, TableHasNoNumberWhereThereIsNone) {
  const std::string text = written(
      [](Output& output) { write_summary(output, summarise(matrix({row("r1", "e", true, 0, 4, 3, 1, 2, 8)}))); });
  EXPECT_NE(text.find("gridworld\t1\tsynpo\t0\t0\tunseen\t0\t0\t0\t0\tNA\tNA\tNA\tNA\tNA\tNA\t"), std::string::npos)
      << text;
  EXPECT_NE(text.find("\t0.75\t0.75\tNA\t0.5\t0.5\tNA\t2\t2\tNA\t0.25\t0.25\tNA\t0\t0\tNA\tNA\n"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace synpo
