#include "format/pairs.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/error.h"
#include "format/tsv.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

constexpr char kGolden[] = "tests/data/v1/";

TEST(GoldenV1, Pairs) {
  Input input(concat(kGolden, "pairs.tsv"));
  const std::vector<PairRow> rows = read_pairs(input);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].env + " " + rows[0].task, "map1 R-B");
  EXPECT_TRUE(rows[0].seen && rows[2].seen);
  EXPECT_FALSE(rows[1].seen || rows[3].seen);
  EXPECT_EQ(rows[2].part, "Q");
}

std::vector<PairRow> pairs_of(const std::string& text) {
  return read_text(text, [](Input& input) { return read_pairs(input); });
}

TEST(Pairs, ReadsColumnsInAnyOrder) {
  const auto rows = pairs_of("note\tseen\ttask\tpart\tenv\nx\t0\tR-B\tQ\tmap2\ny\t1\tB-G\t\tmap1\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].env, "map2");
  EXPECT_EQ(rows[0].task, "R-B");
  EXPECT_FALSE(rows[0].seen);
  EXPECT_EQ(rows[0].part, "Q");
  EXPECT_TRUE(rows[1].seen);
  EXPECT_TRUE(pairs_of("env\ttask\na\tb\n")[0].seen) << "no such column: every row counts as seen";
}

TEST(Pairs, RefusesWhatIsNoPairs) {
  const auto refused_pairs = [](const std::string& text) { return thrown([&] { pairs_of(text); }); };
  EXPECT_EQ(refused_pairs("env\n"), "65 IN: line 1: no column 'task', found 'env'");
  EXPECT_EQ(refused_pairs("env\ttask\n"), "65 IN: line 1: found a header and no row, expected at least one pair");
  EXPECT_EQ(refused_pairs("env\ttask\na\tb\nc\td\na\tb\n"), "65 IN: line 4: pair 'a', 'b' stands in line 2 already");
  EXPECT_EQ(refused_pairs("env\ttask\tseen\na\tb\tyes\n"),
            "65 IN: line 2, column 3 ('seen'): found 'yes', expected a whole number from 0 to 1");
  EXPECT_EQ(refused_pairs("env\ttask\tpart\na\tb\tR\n"),
            "65 IN: line 2, column 3 ('part'): found 'R', expected P, Q, rest or nothing");
  EXPECT_EQ(refused_pairs("env\ttask\n\tb\n"),
            "65 IN: line 2, column 1 ('env'): found '', expected the name of an environment");
  EXPECT_EQ(refused_pairs("env\ttask\na\t\n"),
            "65 IN: line 2, column 2 ('task'): found '', expected the name of a task");
}

TEST(Pairs, WritesThePartOnlyWhereThereIsOne) {
  EXPECT_EQ(written([](Output& output) {
              write_pairs(output, {{"a", "b", true, ""}, {"a", "c", false, ""}});
            }),
            "env\ttask\tseen\na\tb\t1\na\tc\t0\n");
  const std::string text = written([](Output& output) {
    write_pairs(output, {{"a", "b", true, "P"}, {"a", "c", false, ""}});
  });
  EXPECT_EQ(text, "env\ttask\tseen\tpart\na\tb\t1\tP\na\tc\t0\t\n");
  EXPECT_EQ(pairs_of(text)[0].part, "P");
}

}  // namespace
}  // namespace synpo
