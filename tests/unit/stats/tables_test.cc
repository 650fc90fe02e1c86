#include <cmath>

#include "helpers/table_helpers.h"
#include "stats/bootstrap.h"
#include "stats/matrix/filter.h"
#include "stats/report/compare.h"
#include "stats/report/margins.h"
#include "stats/report/method_table.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

MatrixRow row(const std::string& run, uint64_t seed, const std::string& env, const std::string& task, bool seen,
              int64_t successes, int64_t episodes = 10, const std::string& method = "synpo") {
  MatrixRow r;
  r.run = run;
  r.world = "gridworld";
  r.method = method;
  r.seed = seed;
  r.env = env;
  r.task = task;
  r.seen = seen;
  r.episodes = episodes;
  r.successes = successes;
  return r;
}

Matrix matrix(std::vector<MatrixRow> rows) {
  Matrix m;
  m.rows = std::move(rows);
  return m;
}

const MeasureKind& success() { return find_measure("success"); }

// Newcombe 1998, Interval estimation for the difference between independent proportions, Table II, method 10.
TEST(Newcombe, Published) {
  const struct {
    int64_t k1, n1, k2, n2;
    double low, high;
  } cases[] = {{56, 70, 48, 80, 0.0524, 0.3339}, {9, 10, 3, 10, 0.1705, 0.8090},  {6, 7, 2, 7, 0.0582, 0.8062},
               {5, 56, 0, 29, -0.0381, 0.1926},  {0, 10, 0, 20, -0.1611, 0.2775}, {0, 10, 0, 10, -0.2775, 0.2775},
               {10, 10, 0, 20, 0.6791, 1.0000},  {10, 10, 0, 10, 0.6075, 1.0000}};
  for (const auto& c : cases) {
    const Interval interval = newcombe(c.k1, c.n1, c.k2, c.n2), mirror = newcombe(c.k2, c.n2, c.k1, c.n1);
    EXPECT_NEAR(interval.low, c.low, 5e-5) << c.k1 << " of " << c.n1;
    EXPECT_NEAR(interval.high, c.high, 5e-5) << c.k1 << " of " << c.n1;
    EXPECT_NEAR(mirror.low, -interval.high, 1e-15);
  }
}

// Newcombe 1998, Two-sided confidence intervals for the single proportion, Table I, method 3.
TEST(Wilson, Published) {
  EXPECT_NEAR(wilson(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson(15, 148).high, 0.1605, 5e-5);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson(1, 29).low, 0.0061, 5e-5);
  EXPECT_NEAR(wilson(1, 29).high, 0.1718, 5e-5);
}

// A quarter, rounded down, cut off at either end: Agarwal et al. 2021, footnote on scipy's trim_mean with 0.25.
TEST(InterquartileMean, HandComputed) {
  EXPECT_DOUBLE_EQ(interquartile_mean({5, 8, 4, 38, 8, 6, 9, 7, 7, 3, 1, 6}), 6.5);  // of 5 6 6 7 7 8
  EXPECT_DOUBLE_EQ(interquartile_mean({1, 100, 3}), 104.0 / 3);                      // too few to cut
  EXPECT_DOUBLE_EQ(interquartile_mean({9, 1, 2, 4, 100}), 5);                        // of 2 4 9
  EXPECT_TRUE(std::isnan(interquartile_mean({})));
  EXPECT_TRUE(std::isnan(interquartile_mean({1, NAN, 2})));
}

// R: quantile(1:4, c(0.25, 0.5)); NumPy: percentile([15, 20, 35, 40, 50], 40).
TEST(Quantile, TypeSeven) {
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4}, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({15, 20, 35, 40, 50}, 0.4), 29);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.975), 7);
  EXPECT_DOUBLE_EQ(quantile({1, 2}, 1), 2);
}

PairValues one_pair(const std::vector<double>& values) {
  PairValues pairs(1);
  for (size_t r = 0; r < values.size(); ++r) pairs[0].push_back({uint32_t(r), values[r]});
  return pairs;
}

// All samples of few runs can be counted out.
TEST(Bootstrap, FewRunsCountedOut) {
  const Interval two = bootstrap_mean(one_pair({0, 1}), 2, {});  // 0 and 1 in 1 of 4 samples each
  EXPECT_EQ(two.low, 0);
  EXPECT_EQ(two.high, 1);
  // The mean is the number of fours: binomial (4, 1/4), P(4) = 0.4 %, P(3 or 4) = 5.1 %.
  const Interval four = bootstrap_mean(one_pair({0, 4, 0, 0}), 4, {10000, 1, false});
  EXPECT_EQ(four.low, 0);
  EXPECT_EQ(four.high, 3);
  EXPECT_TRUE(std::isnan(bootstrap_mean(one_pair({0.3}), 1, {}).low)) << "one run says nothing of others";
  EXPECT_TRUE(std::isnan(bootstrap_mean(one_pair({1, 1, 1}), 3, {}).low)) << "nor do runs that are all alike";
}

// Efron 1979: the bootstrap's standard error of a mean of n is sqrt((n - 1) / n) sd / sqrt(n).
TEST(Bootstrap, ManyRunsAsTheFormulaHasIt) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i % 10);
  const Interval interval = bootstrap_mean(one_pair(values), 100, {20000, 3, false});
  const double half = 1.96 * std::sqrt(8.25) / 10;  // the variance of 0 to 9 with divisor n
  EXPECT_NEAR(interval.low, 4.5 - half, 0.03);
  EXPECT_NEAR(interval.high, 4.5 + half, 0.03);
}

// One run fails at everything and one at nothing: drawn whole, the mean of two is 0 in a quarter of the samples; drawn
// in each of 100 pairs on its own it has the variance 1/4 / 2 / 100.
TEST(Bootstrap, WholeRunsAndPairByPair) {
  const PairValues pairs(100, {{0, 0.0}, {1, 1.0}});
  const Interval whole = bootstrap_mean(pairs, 2, {4000, 1, false}), apart = bootstrap_mean(pairs, 2, {4000, 1, true});
  EXPECT_EQ(whole.low, 0);
  EXPECT_EQ(whole.high, 1);
  EXPECT_NEAR(apart.low, 0.5 - 1.96 * std::sqrt(1.0 / 800), 0.006);
  EXPECT_NEAR(apart.high, 0.5 + 1.96 * std::sqrt(1.0 / 800), 0.006);
}

TEST(Bootstrap, DifferencesOverPairs) {
  PairValues a(400, {{0, 0.0}}), b = a;
  for (size_t p = 0; p < 400; p += 2) b[p][0].value = 1;
  const Interval interval = bootstrap_difference(a, 1, b, 1, false, {4000, 1, false});
  EXPECT_NEAR(interval.low, 0.5 - 1.96 * 0.5 / 20, 0.005);
  EXPECT_NEAR(interval.high, 0.5 + 1.96 * 0.5 / 20, 0.005);
}

TEST(Bootstrap, MatchedRunsAreDrawnTogether) {
  const PairValues a = one_pair({0.2, 0.8}), b = one_pair({0.3, 0.9});
  EXPECT_TRUE(std::isnan(bootstrap_difference(a, 2, b, 2, true, {}).low)) << "0.1 in every sample";
  const Interval apart = bootstrap_difference(a, 2, b, 2, false, {});  // the ends in 1 of 16 samples each
  EXPECT_NEAR(apart.low, -0.5, 1e-12);
  EXPECT_NEAR(apart.high, 0.7, 1e-12);
}

TEST(Bootstrap, TheSeedDecides) {
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(std::sqrt(i));
  const auto interval = [&](uint64_t seed) { return bootstrap_mean(one_pair(values), 20, {500, seed, false}); };
  EXPECT_EQ(interval(1).low, interval(1).low);
  EXPECT_NE(interval(1).low, interval(2).low);
}

TEST(Text, RatesAreNeverRoundedToCertainty) {
  EXPECT_EQ(percent(1), "100.0");
  EXPECT_EQ(percent(0), "0.0");
  EXPECT_EQ(percent(0.99999), "99.9");
  EXPECT_EQ(percent(0.00001), "0.1");
  EXPECT_EQ(percent(0.999, 0), "99");
  EXPECT_EQ(percent(NAN), "-");
  EXPECT_EQ(spread_text({3, 1, 0}, success()), "100.0 (3 alike)");
  EXPECT_EQ(spread_text(mean_sd({0.7, 0.7, 0.7, 0.7, 0.7, 0.7}), success()), "70.0 (6 alike)")
      << "whatever rounding leaves";
  EXPECT_EQ(spread_text(mean_sd({0.9996, 1, 1}), success()), "99.99 +- 0.02");
  EXPECT_EQ(spread_text(mean_sd({0.8, 0.8002}), success()), "80.01 +- 0.01") << "and not 0.0";
  EXPECT_EQ(spread_text({1, 0.8, NAN}, success()), "80.0");
  EXPECT_EQ(spread_text({0, NAN, NAN}, success()), "-");
  EXPECT_EQ(spread_text({2, 7.125, 0.5}, find_measure("reward")), "7.12 +- 0.50");
  EXPECT_EQ(decimal(-0.001, 2), "0.00");
}

TEST(Text, TablesInEveryFormat) {
  const std::vector<std::vector<std::string>> rows = {
      {"method", "seen %"}, {"a_b|\xc3\xa9", "85.0 +- 1.2"}, {"c", "-"}};
  EXPECT_EQ(table_text(rows), "method       seen %\na_b|\xc3\xa9   85.0 +- 1.2\nc                 -\n");
  EXPECT_EQ(table_text(rows, TableFormat::kMarkdown),
            "| method  |     seen % |\n| ------- | ---------: |\n| a\\_b\\|\xc3\xa9 | 85.0 \xc2\xb1 1.2 |\n| c       | "
            "         - |\n");
  EXPECT_EQ(table_text(rows, TableFormat::kLatex),
            "\\begin{tabular}{lr}\n\\toprule\nmethod & seen \\% \\\\\n\\midrule\na\\_b|\xc3\xa9 & 85.0 $\\pm$ 1.2 "
            "\\\\\nc & - \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
  EXPECT_EQ(table_text({{"\\&%$#_{}~^"}}, TableFormat::kLatex).substr(28, 51),
            "\\textbackslash{}\\&\\%\\$\\#\\_\\{\\}\\~{}\\^{} \\\\\n\\midrule\n");
}

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
  EXPECT_DOUBLE_EQ(cell.iqm, 0.7);  // of 0.6 and 0.8
  EXPECT_DOUBLE_EQ(cell.interval.low, 0.7);
  EXPECT_DOUBLE_EQ(cell.interval.high, 0.75);
  EXPECT_FALSE(cell.wilson);
  EXPECT_TRUE(std::isnan(table.lines[0].cells[1].over_runs.mean));
  EXPECT_TRUE(std::isnan(table.lines[0].cells[1].interval.low));
  EXPECT_EQ(table.lines[1].label, "mlp");
  EXPECT_TRUE(table.lines[1].cells[0].wilson);
  EXPECT_DOUBLE_EQ(table.lines[1].cells[0].interval.low, wilson(3, 10).low);
  const std::string text = method_table_text(table, TableFormat::kText, false);
  EXPECT_TRUE(
      text.starts_with("method  runs       seen %   IQM   95 % interval  unseen %  IQM  95 % interval\n"
                       "synpo      2  72.5 +- 3.5  70.0    70.0 to 75.0         -    -              -\n"
                       "mlp        1         30.0  30.0  10.8 to 60.3 w         -    -              -\n"))
      << text;
  EXPECT_EQ(method_table_text(table, TableFormat::kText, true).find("IQM"), std::string::npos);
  EXPECT_EQ(method_table_text(table, TableFormat::kLatex, true).substr(0, 2), "% ");
  const std::string tsv = written([&](Output& output) { write_method_table(output, table); });
  EXPECT_NE(tsv.find("gridworld\t1\tmlp\tseen\tsuccess\t1\t1\t10\t0.3\tNA\t0.3\t0.107"), std::string::npos) << tsv;
  EXPECT_NE(tsv.find("gridworld\t1\tmlp\tunseen\tsuccess\t0\t0\t0\tNA\tNA\tNA\tNA\tNA\tNA\n"), std::string::npos)
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

TEST(MethodTable, OnlyABootstrapOfFewRunsIsTooNarrow) {
  std::vector<MatrixRow> rows = {row("m", 1, "e", "t", true, 5, 10, "mlp")};
  for (uint64_t seed = 1; seed <= 12; ++seed)
    rows.push_back(row("r" + std::to_string(seed), seed, "e", "t", true, 3 + seed % 4));
  const auto warns = [&] {
    return method_table_text(tabulate(matrix(rows), {"seen"}, success(), {}), TableFormat::kText, false)
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
  EXPECT_NE(text.find("100.0 (3 alike)  100.0  88.6 to 100.0 w"), std::string::npos) << text;
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

TEST(Compare, HandComputed) {
  const MatrixSource a{"a", matrix({row("a", 1, "e", "t", true, 50, 100), row("a", 1, "f", "t", false, 20, 100),
                                    row("a", 1, "g", "t", true, 10, 100), row("a", 1, "h", "t", true, 1, 100),
                                    row("a", 1, "i", "t", true, 1, 100)})};
  const MatrixSource b{
      "b", matrix({row("b", 1, "e", "t", true, 60, 100, "mlp"), row("b", 1, "f", "t", false, 70, 100, "mlp"),
                   row("b", 1, "g", "t", true, 10, 50, "mlp"), row("b", 1, "h", "t", false, 9, 100, "mlp")})};
  const Comparison c = compare(a, b, false, {});
  EXPECT_TRUE(c.matched);
  EXPECT_EQ(c.other_starts, 1) << "g: 100 episodes and 50";
  EXPECT_EQ(c.other_seen, 1) << "h";
  EXPECT_EQ(c.only_one, 1) << "i";
  ASSERT_EQ(c.subsets.size(), 3u);
  EXPECT_EQ(c.subsets[2].name, "all");
  EXPECT_EQ(c.subsets[2].pairs, 2);
  EXPECT_EQ(c.subsets[2].better, 2);
  EXPECT_DOUBLE_EQ(c.subsets[2].mean_a, 0.35);
  EXPECT_DOUBLE_EQ(c.subsets[2].mean_b, 0.65);
  EXPECT_NEAR(c.subsets[2].change, 0.3, 1e-12);
  EXPECT_NEAR(c.subsets[2].interval.low, 0.1, 1e-12);   // e drawn twice
  EXPECT_NEAR(c.subsets[2].interval.high, 0.5, 1e-12);  // f drawn twice
  EXPECT_TRUE(std::isnan(c.subsets[0].interval.low)) << "one pair and one run each";
  EXPECT_EQ(c.pairs.at(0).env, "f");
  EXPECT_DOUBLE_EQ(c.pairs[0].change(), 0.5);
  EXPECT_DOUBLE_EQ(c.pairs[0].interval.low, newcombe(70, 100, 20, 100).low);
  const std::string text = comparison_text(c, 1);
  EXPECT_NE(text.find("f    t     unseen  20 of 100  70 of 100  +50.0  +36.9 to +60.5\n"), std::string::npos) << text;
  EXPECT_NE(text.find("Left out: 1 pair that only one of the two has; 1 pair seen by one and unseen by the other; 1 "
                      "pair without common"),
            std::string::npos)
      << text;
  EXPECT_EQ(compare(a, b, true, {}).subsets.back().pairs, 3);
}

TEST(Compare, RunsOfOneSeedBelongTogetherInAnyOrder) {
  // Seed by seed B is better by 0.1, and the seeds differ by 0.5.
  const MatrixSource a{"a", matrix({row("a1", 1, "e", "t", true, 2), row("a2", 2, "e", "t", true, 7)})};
  const MatrixSource b{"b", matrix({row("b2", 2, "e", "t", true, 8), row("b1", 1, "e", "t", true, 3)})};
  EXPECT_TRUE(std::isnan(compare(a, b, false, {}).subsets[0].interval.low));
  MatrixSource other = b;
  other.matrix.rows[0].seed = 3;
  const Comparison apart = compare(a, other, false, {});
  EXPECT_FALSE(apart.matched);
  EXPECT_NEAR(apart.subsets[0].interval.low, -0.4, 1e-12);
  EXPECT_NEAR(apart.subsets[0].interval.high, 0.6, 1e-12);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const MatrixSource a{"a.tsv", matrix({row("a", 1, "e", "t", true, 5)})};
  MatrixSource b = a;
  b.name = "b.tsv";
  b.matrix.rows[0].world = "kitchen";
  EXPECT_EQ(thrown([&] { compare(a, b, false, {}); }),
            "65 b.tsv: found world 'kitchen', expected 'gridworld' as in a.tsv");
  b.matrix.rows = {row("a", 1, "e", "t", true, 5), row("m", 1, "e", "t", true, 5, 10, "mlp")};
  EXPECT_EQ(
      thrown([&] { compare(a, b, false, {}); }),
      "65 b.tsv: rows of several methods, worlds or windows: choose with synpo-matrix filter what is to be compared");
  b.matrix.rows = {row("b", 1, "e", "t", true, 5)};
  b.matrix.rows[0].eval_seed = 9;
  EXPECT_EQ(thrown([&] { compare(a, b, false, {}); }),
            "65 a.tsv and b.tsv have no pair with the same start states (eval_seed, first_episode, episodes) and the "
            "same seen; "
            "--any-start compares other start states, too");
  EXPECT_EQ(thrown([&] { compare(a, b, true, {}); }), "nothing thrown");
  MatrixSource in_p = a;
  in_p.matrix.rows[0].part = "P";
  b.matrix.rows[0].part = "Q";
  EXPECT_EQ(thrown([&] { compare(in_p, b, true, {}); }), "65 a.tsv and b.tsv: pair 'e', 't' is in part 'P' and in 'Q'");
  for (const auto& [one, other] : {std::pair(a, in_p), std::pair(in_p, a)}) {
    const Comparison c = compare(one, other, true, {});
    EXPECT_EQ(c.subsets.back().name, "P") << "the part that one side has";
  }
}

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
  EXPECT_NE(tsv.find("\t0.9\t0.1\tNA\tNA\tu\t0.1\n"), std::string::npos) << tsv;
}

TEST(Filter, EveryOptionNarrows) {
  Matrix m = matrix(
      {row("r1", 1, "e", "t", true, 1), row("r1", 1, "e", "u", false, 2), row("r2", 2, "f", "t", true, 3, 10, "mlp")});
  m.has_part = true;
  m.rows[1].part = "Q";
  const auto left = [&](const RowFilter& filter) {
    std::string successes;
    for (const MatrixRow& r : filter_rows(m, filter).rows) successes += std::to_string(r.successes);
    return successes;
  };
  RowFilter f;
  EXPECT_EQ(left(f), "123");
  f.envs = {"e"};
  EXPECT_EQ(left(f), "12");
  f.seen = false;
  EXPECT_EQ(left(f), "2");
  f.inverted = true;
  EXPECT_EQ(left(f), "13");
  f = {};
  f.pairs = {{"f", "t"}, {"e", "u"}};
  EXPECT_EQ(left(f), "23");
  f = {};
  f.methods = {"mlp"};
  EXPECT_EQ(left(f), "3");
  f = {};
  f.seeds = {1};
  f.tasks = {"t"};
  EXPECT_EQ(left(f), "1");
  f = {};
  f.parts = {"Q"};
  EXPECT_EQ(left(f), "2");
  f.seen = true;
  f.unseen = false;
  EXPECT_EQ(thrown([&] { left(f); }), "65 no row is left of 3, and a matrix has at least one");
  f = {};
  f.envs = {"g"};
  EXPECT_EQ(thrown([&] { left(f); }), "65 the matrix has no environment 'g'");
  f = {};
  f.pairs = {{"f", "u"}};
  EXPECT_EQ(thrown([&] { left(f); }), "65 the matrix has no pair 'f', 'u'");
  f = {};
  f.seeds = {7};
  EXPECT_EQ(thrown([&] { left(f); }), "65 the matrix has no seed 7");
}

TEST(Wide, TasksDownAndEnvironmentsAcross) {
  const Matrix m =
      matrix({row("r1", 1, "e", "t", true, 1), row("r2", 2, "e", "t", true, 4), row("r1", 1, "f", "u", false, 10)});
  const auto wide = [&](const std::string& measure) {
    return written([&](Output& output) { write_wide(output, m, {"e", "f"}, {"t", "u"}, measure); });
  };
  EXPECT_EQ(wide("success"), "task\te\tf\nt\t0.25\tNA\nu\tNA\t1\n");
  EXPECT_EQ(wide("episodes"), "task\te\tf\nt\t20\tNA\nu\tNA\t10\n");
  EXPECT_EQ(wide("successes"), "task\te\tf\nt\t5\tNA\nu\tNA\t10\n");
  EXPECT_EQ(wide("seen"), "task\te\tf\nt\t1\tNA\nu\tNA\t0\n");
  EXPECT_EQ(wide("length"), "task\te\tf\nt\tNA\tNA\nu\tNA\tNA\n");
}

}  // namespace
}  // namespace synpo
