#include "stats/report/summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"
#include "stats/interval.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/runs.h"

namespace synpo {
namespace {

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

TEST(Summary, OneEpisodeIsEnoughForARate) {
  const auto groups = summarise(matrix({row("r1", "e", true, 0, 1, 1, 0, 11.9, 12)}));
  const SubsetSummary& seen = groups.at(0).subsets.at(0);
  EXPECT_DOUBLE_EQ(seen.success.pooled, 1);
  EXPECT_DOUBLE_EQ(seen.reward.pooled, 11.9);
  EXPECT_DOUBLE_EQ(seen.length.pooled, 12);
}

TEST(Summary, PaintsTheNamesOfItsLines) {
  const auto groups = summarise(matrix({row("r1", "e", true, 0, 10, 8), row("r1", "f", false, 0, 10, 4)}));
  const auto paint = [](const SubsetSummary&, const std::string& name) { return "<" + name + ">"; };
  std::string painted = summary_text(groups, paint);
  for (const char* name : {"seen", "unseen", "all"}) {
    const size_t at = painted.find("\n<" + std::string(name) + ">");
    ASSERT_NE(at, std::string::npos) << painted;
    painted.replace(at, std::string(name).size() + 3, "\n" + std::string(name));
  }
  EXPECT_EQ(painted, summary_text(groups));
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

TEST(Heading, NamesTheRangeOfUpdatesAndTheFirstTwentySeeds) {
  Matrix m;
  const auto heading_of = [&m] { return heading(group_runs(m).at(0)); };
  std::string seeds;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    m.rows.push_back(row("r" + std::to_string(seed), seed, "e", "R-B", true, 1));
    m.rows.back().updates = int64_t(seed == 7 ? 90 : 50);
    m.rows.back().temperature = 0.5;
    seeds += " " + std::to_string(seed);
  }
  const std::string start = "synpo on gridworld, window 1, 50 to 90 updates, temperature 0.5: ";
  EXPECT_EQ(heading_of(), start + "20 runs (seeds" + seeds + ")");
  m.rows.push_back(m.rows[0]);
  m.rows.back().run = "r21";
  m.rows.back().seed = 21;
  EXPECT_EQ(heading_of(), start + "21 runs (seeds" + seeds + " ...)");
  m.rows.resize(1);
  EXPECT_EQ(heading_of(), "synpo on gridworld, window 1, 50 updates, temperature 0.5: 1 run (seed 1)");
}

TEST(Summary, NewPairsAreNotUnseenOnes) {
  Matrix m = matrix({row("r1", "e", true, 0, 10, 8), row("r1", "f", false, 0, 10, 6), row("r1", "g", false, 0, 10, 1)});
  m.rows[2].is_new = true;
  const auto subsets = summarise(m).at(0).subsets;
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
