#include "format/matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

constexpr char kGolden[] = "tests/data/v1/";

TEST(GoldenV1, Matrix) {
  Input input(std::string(kGolden) + "matrix.tsv");
  const Matrix matrix = read_matrix(input);
  ASSERT_EQ(matrix.rows.size(), 4u);
  EXPECT_TRUE(matrix.has_part);
  const MatrixRow& row = matrix.rows[1];
  EXPECT_EQ(row.run, "e0507b4a3a05fe54");
  EXPECT_EQ(row.env + " " + row.task, "map1 B-G");
  EXPECT_EQ(row.window, 2);
  EXPECT_EQ(row.successes + 10 * row.wrong + 100 * row.timeouts + 1000 * row.episodes, 3111);
  EXPECT_EQ(row.reward, -1.55);
  EXPECT_EQ(row.length, 355);
  EXPECT_TRUE(matrix.rows[0].seen);
  EXPECT_EQ(matrix.rows[3].part, "rest");
}

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

TEST(Matrix, AnyColumnMayComeFirst) {
  const Matrix matrix = matrix_of(kFull);
  const auto fields_of = [](const std::string& text) {
    std::vector<std::vector<std::string>> lines(1);
    for (size_t begin = 0, end; begin < text.size(); begin = end + 1) {
      end = text.find_first_of("\t\n", begin);
      lines.back().push_back(text.substr(begin, end - begin));
      if (text[end] == '\n' && end + 1 < text.size()) lines.emplace_back();
    }
    return lines;
  };
  std::vector<std::vector<std::string>> lines = fields_of(kFull);
  for (size_t turn = 0; turn < lines[0].size(); ++turn) {
    std::string text;
    for (std::vector<std::string>& fields : lines) {
      std::rotate(fields.begin(), fields.begin() + 1, fields.end());
      for (const std::string& field : fields) text += field + '\t';
      text.back() = '\n';
    }
    EXPECT_EQ(written([&](Output& output) { write_matrix(output, matrix_of(text)); }), kFull) << text;
  }
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
  EXPECT_EQ(matrix_of("env\ttask\tepisodes\tsuccesses\tupdates\ne\tt\t4\t3\t0\n").rows.at(0).updates, 0);
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

TEST(Matrix, TemperatureNewAndHashAreOptional) {
  const std::string text =
      "run\tworld\twindow\tmethod\tseed\tupdates\teval_seed\tfirst_episode\tenv\ttask\tseen\tepisodes\tsuccesses\t"
      "wrong\ttimeouts\treward\tlength\ttemperature\tnew\tenv_hash\n"
      "a\tgridworld\t1\tsynpo\t1\t2\t3\t0\tmap1\tR-B\t0\t5\t5\t0\t0\t1.5\t9\t0.25\t1\tc41dc56a8cd40d27\n"
      "a\tgridworld\t1\tsynpo\t1\t2\t3\t0\tmap1\tB-G\t1\t5\t5\t0\t0\t\t9\t\t0\t\n";
  const Matrix matrix = matrix_of(text);
  EXPECT_EQ(matrix.rows[0].temperature, 0.25);
  EXPECT_EQ(matrix.rows[0].standing(), Standing::kNew);
  EXPECT_EQ(matrix.rows[0].env_hash, "c41dc56a8cd40d27");
  EXPECT_FALSE(matrix.rows[1].temperature);
  EXPECT_EQ(matrix.rows[1].standing(), Standing::kSeen);
  EXPECT_TRUE(std::isnan(matrix.rows[1].reward)) << "an empty field: not counted";
  EXPECT_TRUE(matrix.extra_columns.empty());
  EXPECT_EQ(written([&](Output& output) { write_matrix(output, matrix); }), text);

  const Matrix bare = matrix_of("env\ttask\tepisodes\tsuccesses\ne\tt\t4\t3\n");
  EXPECT_TRUE(std::isnan(bare.rows[0].reward));
  EXPECT_EQ(bare.rows[0].standing(), Standing::kUnseen);
  const std::string again = written([&](Output& output) { write_matrix(output, bare); });
  EXPECT_TRUE(
      again.starts_with("run\tworld\twindow\tmethod\tseed\tupdates\teval_seed\tfirst_episode\tenv\ttask\tseen\t"
                        "episodes\tsuccesses\twrong\ttimeouts\tlength\n"))
      << again;
}

TEST(Matrix, RefusesWhatNewColumnsCannotHold) {
  const auto with = [](const std::string& fields) {
    return refused("env\ttask\tepisodes\tsuccesses\tseen\tnew\ttemperature\n" + fields + "\n");
  };
  EXPECT_EQ(with("a\tb\t9\t1\t0\t1\t0"), "nothing thrown");
  EXPECT_EQ(with("a\tb\t9\t1\t1\t1\t0"),
            "65 IN: line 2, column 6 ('new'): found '1', expected 0 of a pair that is seen");
  EXPECT_EQ(with("a\tb\t9\t1\t0\t2\t0"),
            "65 IN: line 2, column 6 ('new'): found '2', expected a whole number from 0 to 1");
  EXPECT_EQ(with("a\tb\t9\t1\t0\t0\t-1"),
            "65 IN: line 2, column 7 ('temperature'): found '-1', expected a number, at least 0");
  EXPECT_EQ(with("a\tb\t9\t1\t0\t0\thot"),
            "65 IN: line 2, column 7 ('temperature'): found 'hot', expected a finite number");
  EXPECT_EQ(with("a\tb\t9\t1\t0\t0\t0\na\tb\t9\t1\t0\t0\t0.5"), "nothing thrown") << "two runs";
}

TEST(Matrix, WriterRefusesWhatReadersWould) {
  Matrix matrix;
  matrix.rows.resize(1);
  matrix.rows[0].env = matrix.rows[0].task = "x";
  matrix.extra_columns.resize(1000, "c");
  matrix.rows[0].extra.resize(1000);
  EXPECT_TRUE(thrown([&] {
                written([&](Output& output) { write_matrix(output, matrix); });
              }).starts_with("65 a matrix with 1000 columns that are none of this format's"));
  matrix.extra_columns.clear();
  matrix.rows.resize(kMatrixRows + 1);
  EXPECT_EQ(thrown([&] { written([&](Output& output) { write_matrix(output, matrix); }); }),
            "65 a matrix of 1000001 rows, at most 1000000 can be read");
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
