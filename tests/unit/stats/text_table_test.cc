#include "stats/report/text_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/report/margins.h"

namespace synpo {
namespace {

const MeasureKind& success() { return find_measure("success"); }

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

}  // namespace
}  // namespace synpo
