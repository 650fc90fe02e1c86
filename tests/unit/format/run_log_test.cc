#include "format/run_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

struct RunLog : TsvLog {
  RunLog(const std::string& path, bool append) : TsvLog(path, append, run_log_columns()) {}
  void write(const RunLogRow& row) { TsvLog::write(run_log_values(row)); }
};

TEST(RunLog, WritesARowAReport) {
  const TemporaryFolder folder;
  {
    RunLog log(folder.file("log"), false);
    RunLogRow row;
    row.update = 100;
    row.states = 51200;
    row.trajectories = 2100;
    row.seconds = 1.5;
    row.loss = 2.25;
    row.right[0] = 0.5;
    row.right[1] = std::nan("");
    row.right[2] = 0.75;
    log.write(row);
    EXPECT_EQ(contents(folder.file("log"))
                  .find("100\t51200\t2100\t1.5\t0\t0\t2.25\t0\t0\t0\t0\t0.5\tNA\t0.75\t0\tNA\tNA\tNA\tNA\n"),
              contents(folder.file("log")).find('\n') + 1);
    row.evaluation = {0.25, -1, 0.125, -2};
    log.write(row);
  }
  const std::string text = contents(folder.file("log"));
  EXPECT_TRUE(text.starts_with("update\tstates\ttrajectories\tseconds\t"));
  EXPECT_TRUE(text.ends_with("\t0.25\t-1\t0.125\t-2\n"));
  // As many fields in every row.
  int tabs[3] = {}, line = 0;
  for (const char c : text) {
    tabs[line] += c == '\t';
    line += c == '\n' && line < 2;
  }
  EXPECT_EQ(tabs[0], 18);
  EXPECT_EQ(tabs[1], 18);
  EXPECT_EQ(tabs[2], 18);
}

TEST(RunLog, IsContinuedOrWrittenAnew) {
  const TemporaryFolder folder;
  const std::string path = folder.file("log");
  RunLog(path, true).write({});
  const std::string once = contents(path), header = once.substr(0, once.find('\n') + 1);
  EXPECT_TRUE(header.starts_with("update\t"));
  RunLog(path, true).write({});
  EXPECT_EQ(contents(path), once + once.substr(header.size()));
  RunLog(path, false).write({});
  EXPECT_EQ(contents(path), once);
}

TEST(RunLog, NamesWhatFails) {
  const TemporaryFolder folder;
  RunLog("", false).write({});
  RunLog full("/dev/full", false);
  EXPECT_FALSE(full.failed());
  full.check();
  full.write({});
  EXPECT_TRUE(full.failed());
  full.write({});
  EXPECT_EQ(thrown([&] { full.check(); }), "74 cannot write '/dev/full': No space left on device");
  EXPECT_EQ(thrown([&] { RunLog none(folder.file("a/b"), false); }),
            "73 cannot create '" + folder.file("a/b") + "': No such file or directory");
}

std::string log_text(const std::string& rows) {
  return "update\tstates\tseconds\tstates_per_s\tpolicy\tseen_success\n" + rows;
}

RunLogTable read_log(const std::string& rows, RunLogAxis axis) {
  return read_text(log_text(rows), [&](Input& input) { return read_run_log(input, axis, {"policy", "seen_success"}); });
}

TEST(ReadRunLog, TakesColumnsByNameAndNaAsNothing) {
  const RunLogTable log = read_log("10\t100\t1\t100\t2.5\tNA\n20\t200\t2\t100\tNA\t0.25\n", RunLogAxis::kStates);
  EXPECT_EQ(log.x, (std::vector<double>{100, 200}));
  EXPECT_EQ(log.columns[0][0], 2.5);
  EXPECT_TRUE(std::isnan(log.columns[0][1]));
  EXPECT_TRUE(std::isnan(log.columns[1][0]));
  EXPECT_EQ(log.columns[1][1], 0.25);
  const RunLogTable states_first = read_text("states\tpolicy\tupdate\n7\t2\t1\n", [](Input& input) {
    return read_run_log(input, RunLogAxis::kStates, {"policy"});
  });
  EXPECT_EQ(states_first.x, std::vector<double>{7});
}

TEST(ReadRunLog, OfUpdatesDoneAgainTheLaterRowsCount) {
  const std::string first = "1\t10\t1\t10\t9\tNA\n2\t20\t2\t10\t8\tNA\n3\t30\t3\t10\t7\tNA\n";
  const RunLogTable log = read_log(first + "2\t20\t1\t10\t6\tNA\n4\t40\t3\t10\t5\tNA\n", RunLogAxis::kUpdates);
  EXPECT_EQ(log.x, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(log.columns[0], (std::vector<double>{9, 6, 5}));
}

TEST(ReadRunLog, MinutesGoOnWhereARunIsResumed) {
  // 6000 states at 100 a second are a minute. The second process begins at 12000 states; its clock begins at 0, and its
  // second row comes after an evaluation of half a minute.
  const RunLogTable log =
      read_log("1\t6000\t60\t100\t1\t0\n2\t12000\t120\t100\t1\t0\n3\t18000\t60\t100\t1\t0\n4\t24000\t150\t100\t1\t0\n",
               RunLogAxis::kMinutes);
  EXPECT_EQ(log.x.size(), 4u);
  EXPECT_DOUBLE_EQ(log.x[2], 3);
  EXPECT_DOUBLE_EQ(log.x[3], 4.5);
  // Its first row after more seconds than the first process had: less time has passed than the states took.
  EXPECT_DOUBLE_EQ(read_log("1\t600\t6\t100\t1\t0\n2\t6600\t60\t100\t1\t0\n", RunLogAxis::kMinutes).x[1], 1.1);
  // Killed and done again: the time up to the row that is kept.
  const RunLogTable killed =
      read_log("1\t6000\t60\t100\t1\t0\n2\t12000\t120\t100\t1\t0\n2\t12000\t60\t100\t1\t0\n", RunLogAxis::kMinutes);
  EXPECT_DOUBLE_EQ(killed.x[1], 2);
}

TEST(ReadRunLog, NamesThePlaceOfWhatIsWrong) {
  const auto message = [](const std::string& rows, RunLogAxis axis) { return thrown([&] { read_log(rows, axis); }); };
  const RunLogAxis updates = RunLogAxis::kUpdates, states = RunLogAxis::kStates, minutes = RunLogAxis::kMinutes;
  EXPECT_EQ(message("1\t10\t1\t10\tnan\tNA\n", updates),
            "65 IN: line 2, column 5 ('policy'): found 'nan', expected a finite number, or NA");
  EXPECT_EQ(message("1\t10\t1\t10\t1\t1.01\n", updates),
            "65 IN: line 2, column 6 ('seen_success'): found '1.01', expected a rate from 0 to 1, or NA");
  EXPECT_EQ(message("1\t10\t1\t10\t1\tNA\n2\t10\t2\t10\t1\tNA\n", states),
            "65 IN: line 3, column 2 ('states'): found '10', expected more than the 10 of the row before");
  EXPECT_EQ(message("1\t10\t1\t0\t1\tNA\n", minutes),
            "65 IN: line 2, column 4 ('states_per_s'): found '0', expected a rate above 0");
  EXPECT_EQ(message("1\t10\t-1\t10\t1\tNA\n", minutes),
            "65 IN: line 2, column 3 ('seconds'): found '-1', expected a time of at least 0");
  EXPECT_EQ(message("x\t10\t1\t10\t1\tNA\n", updates).substr(0, 37), "65 IN: line 2, column 1 ('update'): f");
  const auto columns = [](const std::string& text) {
    return thrown(
        [&] { read_text(text, [](Input& input) { return read_run_log(input, RunLogAxis::kMinutes, {"policy"}); }); });
  };
  EXPECT_EQ(columns("env\ttask\na\tb\n"), "65 IN: line 1: no column 'update', found 'env', 'task'");
  EXPECT_EQ(columns("update\tstates\n"), "65 IN: line 1: no column 'seconds', found 'update', 'states'");
}

}  // namespace
}  // namespace synpo
