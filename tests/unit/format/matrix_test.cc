#include "format/matrix.h"

#include "helpers/table_helpers.h"

namespace synpo {
namespace {

Matrix matrix_of(const std::string& text) {
  return read_text(text, [](Input& input) { return read_matrix(input); });
}

std::string refused(const std::string& text) {
  return thrown([&] { matrix_of(text); });
}

const char kFull[] =
    "run\tworld\twindow\tmethod\tseed\tupdates\teval_seed\tfirst_"
    "episode\tenv\ttask\tseen\tepisodes\tsuccesses\twrong\ttimeouts\t"
    "reward\tlength\tpart\thost\n"
    "00000000000000aa\tgridworld\t1\tsynpo\t9223372036854775807\t20000\t7\t50\tmap1\tR-B\t1\t50\t40\t4\t6\t391."
    "27\t1834\tP\tn1\n"
    "00000000000000aa\tgridworld\t1\tsynpo\t9223372036854775807\t20000\t7\t0\tmap1\tB-G\t0\t50\t0\t50\t0\t-507."
    "3\t850\t\t\n";

TEST(Matrix, EveryColumnComesBack) {
  const Matrix matrix = matrix_of(kFull);
  ASSERT_EQ(matrix.rows.size(), 2u);
  const MatrixRow& row = matrix.rows[0];
  EXPECT_EQ(row.run, "00000000000000aa");
  EXPECT_EQ(row.world, "gridworld");
  EXPECT_EQ(row.window, 1);
  EXPECT_EQ(row.method, "synpo");
  EXPECT_EQ(row.seed, 9223372036854775807u);
  EXPECT_EQ(row.updates, 20000);
  EXPECT_EQ(row.eval_seed, 7u);
  EXPECT_EQ(row.first_episode, 50);
  EXPECT_EQ(row.env + " " + row.task, "map1 R-B");
  EXPECT_TRUE(row.seen);
  EXPECT_EQ(row.episodes, 50);
  EXPECT_EQ(row.successes, 40);
  EXPECT_EQ(row.wrong, 4);
  EXPECT_EQ(row.timeouts, 6);
  EXPECT_EQ(row.reward, 391.27);
  EXPECT_EQ(row.length, 1834);
  EXPECT_EQ(row.part, "P");
  EXPECT_EQ(matrix.extra_columns, std::vector<std::string>{"host"});
  EXPECT_EQ(row.extra, std::vector<std::string>{"n1"});
  EXPECT_EQ(written([&](Output& output) { write_matrix(output, matrix); }), kFull);
}

TEST(Matrix, ColumnsInAnyOrderAndMostMayBeMissing) {
  const Matrix matrix = matrix_of("successes\tcolour\tepisodes\ttask\tenv\n3\tred\t4\tt\te\n");
  const MatrixRow& row = matrix.rows.at(0);
  EXPECT_EQ(row.env + row.task, "et");
  EXPECT_EQ(row.episodes, 4);
  EXPECT_EQ(row.successes, 3);
  EXPECT_EQ(row.window, 1);
  EXPECT_FALSE(row.seen);
  EXPECT_FALSE(matrix.has_part);
  EXPECT_EQ(row.extra, std::vector<std::string>{"red"});
}

std::string row_refused(const std::string& fields) {
  return refused("env\ttask\tepisodes\tsuccesses\twrong\ttimeouts\treward\tlength\tseen\tpart\tseed\n" + fields + "\n");
}

TEST(Matrix, RefusesHostileRows) {
  EXPECT_EQ(row_refused("a\tb\t10\t5\t3\t2\t1.5\t99\t1\tP\t1"), "nothing thrown");
  EXPECT_EQ(row_refused("a\tb\t10\t11\t0\t0\t0\t0\t1\t\t1"),
            "65 IN: line 2, column 4 ('successes'): found '11', expected at most 10, the row's episodes");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t5\t1\t0\t0\t1\t\t1"),
            "65 IN: line 2: found 5 successes + 5 wrong + 1 timeouts, expected at most 10, the row's episodes");
  EXPECT_EQ(row_refused("a\tb\t-10\t0\t0\t0\t0\t0\t1\t\t1"),
            "65 IN: line 2, column 3 ('episodes'): found '-10', expected a whole number from 1 to 1000000000000");
  EXPECT_EQ(row_refused("a\tb\t0\t0\t0\t0\t0\t0\t1\t\t1"),
            "65 IN: line 2, column 3 ('episodes'): found '0', expected a whole number from 1 to 1000000000000");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t-1\t0\t0\t0\t1\t\t1"),
            "65 IN: line 2, column 5 ('wrong'): found '-1', expected a whole number from 0 to 1000000000000");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\tnan\t0\t1\t\t1"),
            "65 IN: line 2, column 7 ('reward'): found 'nan', expected a finite number");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\t1e300\t0\t1\t\t1"),
            "65 IN: line 2, column 7 ('reward'): found '1e300', expected a sum between -1e15 and 1e15");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\t0\t0.5\t1\t\t1"),
            "65 IN: line 2, column 8 ('length'): found '0.5', expected a whole number from 0 to 1000000000000");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\t0\t0\ttrue\t\t1"),
            "65 IN: line 2, column 9 ('seen'): found 'true', expected a whole number from 0 to 1");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\t0\t0\t1\tp\t1"),
            "65 IN: line 2, column 10 ('part'): found 'p', expected P, Q, rest or nothing");
  EXPECT_EQ(row_refused("a\tb\t10\t5\t1\t0\t0\t0\t1\tP\t-1"),
            "65 IN: line 2, column 11 ('seed'): found '-1', expected a whole number, at least 0");
  EXPECT_EQ(row_refused("\tb\t10\t5\t1\t0\t0\t0\t1\tP\t1"),
            "65 IN: line 2, column 1 ('env'): found '', expected the name of an environment");
}

TEST(Matrix, RefusesMissingColumnsRepeatedRowsAndNoRows) {
  EXPECT_EQ(refused("env\ttask\tepisodes\n"), "65 IN: line 1: no column 'successes', found 'env', 'task', 'episodes'");
  EXPECT_EQ(refused("env\ttask\tepisodes\tsuccesses\n"),
            "65 IN: line 1: found a header and no row, expected at least one pair");
  EXPECT_EQ(refused("env\ttask\tepisodes\tsuccesses\na\tb\t9\t1\na\tc\t9\t1\na\tb\t9\t1\n"),
            "65 IN: line 4: pair 'a', 'b' from episode 0 on stands in line 2 already (same run and eval_seed)");
  EXPECT_EQ(refused("env\ttask\tepisodes\tsuccesses\tseed\na\tb\t9\t1\t1\na\tb\t9\t1\t2\n"), "nothing thrown")
      << "two runs made by hand";
  EXPECT_EQ(refused("env\ttask\tepisodes\tsuccesses\tfirst_episode\na\tb\t9\t1\t0\na\tb\t9\t1\t9\n"), "nothing thrown");
}

TEST(Matrix, RefusesMoreThanAMillionRows) {
  std::string text = "env\ttask\tepisodes\tsuccesses\n";
  for (int i = 0; i <= 1000000; ++i) text += std::to_string(i) + "\tt\t1\t1\n";
  EXPECT_EQ(refused(text), "65 IN: line 1000002: more than 1000000 rows");
}

TEST(Matrix, WriterRefusesNamesThatWouldBreakTheTable) {
  Matrix matrix;
  matrix.rows.resize(1);
  matrix.rows[0].env = "a\nb";
  EXPECT_TRUE(thrown([&] {
                written([&](Output& output) { write_matrix(output, matrix); });
              }).starts_with("65 the name 'a\\x0ab' holds"));
}

}  // namespace
}  // namespace synpo
