#include <algorithm>
#include <cmath>
#include <tuple>

#include "helpers/table_helpers.h"
#include "stats/bootstrap.h"
#include "stats/chance.h"
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

// All samples of few runs can be counted out.
TEST(Bootstrap, FewRunsCountedOut) {
  const Interval two = stratified_bootstrap({{0, 1}}, {});  // 0 and 1 in 1 of 4 samples each
  EXPECT_EQ(two.low, 0);
  EXPECT_EQ(two.high, 1);
  // The mean is the number of fours: binomial (4, 1/4), P(4) = 0.4 %, P(3 or 4) = 5.1 %.
  const Interval four = stratified_bootstrap({{0, 4, 0, 0}}, {10000, 1});
  EXPECT_EQ(four.low, 0);
  EXPECT_EQ(four.high, 3);
  EXPECT_TRUE(std::isnan(stratified_bootstrap({{0.3}}, {}).low)) << "one run says nothing of others";
  EXPECT_TRUE(std::isnan(stratified_bootstrap({{1, 1, 1}}, {}).low)) << "nor do runs that are all alike";
}

// Efron 1979: the bootstrap's standard error of a mean of n is sqrt((n - 1) / n) sd / sqrt(n).
TEST(Bootstrap, ManyRunsAsTheFormulaHasIt) {
  std::vector<double> values;
  for (int i = 0; i < 100; ++i) values.push_back(i % 10);
  const Interval interval = stratified_bootstrap({values}, {20000, 3});
  const double half = 1.96 * std::sqrt(8.25) / 10;  // the variance of 0 to 9 with divisor n
  EXPECT_NEAR(interval.low, 4.5 - half, 0.03);
  EXPECT_NEAR(interval.high, 4.5 + half, 0.03);
}

// One run fails at everything and one at nothing: drawn in each of 100 pairs on its own, the mean of two has the
// variance 1/4 / 2 / 100.
TEST(Bootstrap, PairByPair) {
  const Interval apart = stratified_bootstrap(std::vector<std::vector<double>>(100, {0, 1}), {4000, 1});
  EXPECT_NEAR(apart.low, 0.5 - 1.96 * std::sqrt(1.0 / 800), 0.006);
  EXPECT_NEAR(apart.high, 0.5 + 1.96 * std::sqrt(1.0 / 800), 0.006);
}

TEST(Bootstrap, TheSeedDecides) {
  std::vector<double> values;
  for (int i = 0; i < 20; ++i) values.push_back(std::sqrt(i));
  const auto interval = [&](uint64_t seed) { return stratified_bootstrap({values}, {500, seed}); };
  EXPECT_EQ(interval(1).low, interval(1).low);
  EXPECT_NE(interval(1).low, interval(2).low);
}

// 1, 2, 3, 4, 9 and 30 degrees of freedom as tables have them; 1.5 and 501 by a program of its own.
TEST(Student, Published) {
  const std::pair<double, double> cases[] = {{1, 12.7062047}, {2, 4.30265273},   {3, 3.18244631},
                                             {4, 2.77644511}, {9, 2.26215716},   {30, 2.04227246},
                                             {1.5, 6.016663}, {501, 1.96471030}, {1e9, 1.95996398}};
  for (const auto& [df, t] : cases) EXPECT_NEAR(student95(df), t, 5e-7 * t) << df;
  const Interval interval = student(mean_sd({2, 4, 9}));  // mean 5, sd sqrt(13)
  EXPECT_NEAR(interval.low, 5 - 4.30265273 * std::sqrt(13.0 / 3), 1e-7);
  EXPECT_NEAR(interval.high, 5 + 4.30265273 * std::sqrt(13.0 / 3), 1e-7);
  EXPECT_TRUE(std::isnan(student(mean_sd({2})).low)) << "one run says nothing of others";
  EXPECT_TRUE(std::isnan(student(mean_sd({2, 2})).low)) << "nor do runs that are all alike";
}

// Enumerated by a program of its own, over all pairs of counts.
TEST(Newcombe, HowOftenItLeavesOutZeroByChance) {
  const struct {
    double rate;
    int64_t n1, n2;
    double often;
  } cases[] = {{0.9, 10, 10, 0.0090402222},
               {0.95, 20, 20, 0.0020950655},
               {0.98, 100, 100, 0.0157867752},
               {0.5, 4, 4, 0.0703125},
               {0.95, 3, 200, 0.1019794283},
               {0.9, 100, 50, 0.0415556634},
               {0.995, 1000, 1000, 0.039406195},
               {0.5, 4, 40000, 0.1249965892},
               {0.5, 10000, 10000, 0.0501468836},
               {1, 5, 5, 0},
               {0, 5, 5, 0}};
  for (const auto& c : cases) {
    EXPECT_NEAR(newcombe_false_alarms(c.rate, c.n1, c.n2), c.often, 1e-8) << c.rate << ' ' << c.n1;
    EXPECT_NEAR(newcombe_false_alarms(1 - c.rate, c.n2, c.n1), c.often, 1e-8) << c.rate << ' ' << c.n1;
  }
  EXPECT_NEAR(newcombe_false_alarms(0.5, 50000, 50000), 0.05, 0.001);
  EXPECT_NEAR(newcombe_false_alarms(0.5, 4, 4000000000000), 0.125, 0.001) << "of 16 outcomes the two ends";
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
  EXPECT_EQ(spread_text({3, 0.99996, 0}, success()), "99.9 (3 alike)");
  EXPECT_EQ(spread_text({2, 7.125, 0.5}, find_measure("reward")), "7.12 +- 0.50");
  EXPECT_EQ(decimal(-0.001, 2), "0.00");
}

TEST(Text, EndsAreNeverRoundedToCertaintyNorToOneNumber) {
  const auto range = [](Interval interval, double mean) { return range_text(interval, mean, success()); };
  EXPECT_EQ(range({0.812, 0.86}, 0.84), "81.2 to 86.0");
  EXPECT_EQ(range({0.9, 0.99991}, 0.95), "90.0 to 99.9");
  EXPECT_EQ(range({0.00009, 0.1}, 0.05), "0.1 to 10.0");
  EXPECT_EQ(range({0, 1}, 0.5), "0.1 to 99.9")
      << "where some succeed and some fail no rate of other episodes is 0 or 1";
  EXPECT_EQ(range({0.8864, 1}, 1), "88.6 to 100.0");
  EXPECT_EQ(range({0, 0.1136}, 0), "0.0 to 11.4");
  // Wilson's of 39,990 in 40,000, worked out apart: 0.999540 to 0.999864, and the rate is 0.99975.
  const Interval near_all = wilson(39990, 40000);
  EXPECT_EQ(range(near_all, 0.99975), "99.95 to 99.99");
  EXPECT_EQ(range_digits(near_all, 0.99975, success()), 2);
  EXPECT_EQ(percent(0.99975, 2), "99.98");
  EXPECT_EQ(range_text({NAN, NAN}, 0.5, success()), "-");
  EXPECT_EQ(range_text({-0.004, 0.002}, 0, find_measure("reward")), "-0.004 to 0.002");
}

TEST(Text, TablesInEveryFormat) {
  const std::vector<std::vector<std::string>> rows = {
      {"method", "seen %"}, {"a_b|\xc3\xa9", "85.0 +- 1.2"}, {"c", "-"}};
  EXPECT_EQ(table_text(rows), "method       seen %\na_b|\xc3\xa9   85.0 +- 1.2\nc                 -\n");
  EXPECT_EQ(table_text(rows, TableFormat::kMarkdown),
            "| method  |     seen % |\n| ------- | ---------: |\n| a\\_b\\|\xc3\xa9 | 85.0 \xc2\xb1 1.2 |\n| c       | "
            "         - |\n");
  EXPECT_EQ(
      table_text(rows, TableFormat::kLatex),
      "\\begin{tabular}{lr}\n\\toprule\nmethod & seen \\% \\\\\n\\midrule\na\\_b\\textbar{}\xc3\xa9 & 85.0 $\\pm$ 1.2 "
      "\\\\\nc & - \\\\\n"
      "\\bottomrule\n\\end{tabular}\n");
  EXPECT_EQ(table_text({{"\\&%$#_{}~^"}}, TableFormat::kLatex).substr(28, 51),
            "\\textbackslash{}\\&\\%\\$\\#\\_\\{\\}\\~{}\\^{} \\\\\n\\midrule\n");
  // In OT1 these would come out as other characters, dashes or arguments of what stands before.
  EXPECT_EQ(table_text({{"[*]<|>\"`a-b--c---d"}}, TableFormat::kLatex).substr(28),
            "{[}{*}{]}\\textless{}\\textbar{}\\textgreater{}{''}\\textasciigrave{}a-b-{}-c-{}-{}-d \\\\\n\\midrule\n"
            "\\bottomrule\n\\end{tabular}\n");
  EXPECT_EQ(table_text({{"a&lt;~~$x$"}}, TableFormat::kMarkdown).substr(0, 17), "| a\\&lt;\\~\\~\\$x\\$");
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
  f.standings = {Standing::kUnseen};
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
  f.standings = {Standing::kSeen};
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

TEST(Filter, ByTemperatureAndByWhatIsNew) {
  Matrix m =
      matrix({row("r1", 1, "e", "t", true, 1), row("r1", 1, "e", "u", false, 2), row("r1", 1, "f", "t", false, 3)});
  m.rows[0].temperature = 0;
  m.rows[1].temperature = 0.5;
  m.rows[2].is_new = true;
  const auto left = [&](const RowFilter& filter) {
    std::string successes;
    for (const MatrixRow& r : filter_rows(m, filter).rows) successes += std::to_string(r.successes);
    return successes;
  };
  RowFilter f;
  f.temperatures = {0, 0.5};
  EXPECT_EQ(left(f), "12");
  f.temperatures = {1};
  EXPECT_EQ(thrown([&] { left(f); }), "65 the matrix has no temperature 1");
  f = {};
  f.standings = {Standing::kNew};
  EXPECT_EQ(left(f), "3");
  f.standings = {Standing::kUnseen};
  EXPECT_EQ(left(f), "2");
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
