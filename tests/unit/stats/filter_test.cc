#include "stats/matrix/filter.h"

#include <gtest/gtest.h>

#include "helpers/matrix_rows.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(Filter, EveryOptionNarrows) {
  Matrix m = matrix(
      {row("r1", 1, "e", "t", true, 1), row("r1", 1, "e", "u", false, 2), row("r2", 2, "f", "t", true, 3, 10, "mlp")});
  m.has_part = true;
  m.rows[1].part = "Q";
  m.extra_columns = {"host"};
  for (MatrixRow& r : m.rows) r.extra = {"n" + std::to_string(r.successes)};
  const auto left = [&](const RowFilter& filter) {
    std::string successes;
    for (const MatrixRow& r : filter_rows(m, filter).rows) successes += std::to_string(r.successes);
    return successes;
  };
  RowFilter f;
  EXPECT_EQ(left(f), "123");
  f.envs = {"e"};
  EXPECT_EQ(left(f), "12");
  EXPECT_EQ(filter_rows(m, f).extra_columns, m.extra_columns);
  EXPECT_EQ(filter_rows(m, f).rows[1].extra, m.rows[1].extra);
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
