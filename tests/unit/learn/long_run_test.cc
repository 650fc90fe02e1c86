#include "learn/long_run.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/signals.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/training.h"

namespace synpo {
namespace {

// Seven updates that say what is asked of them; a checkpoint has its number for a seed.
struct Counting : LongWork {
  void begin() override { said += "begin "; }
  void update(Progress&) override { said += std::to_string(++made) + " "; }
  void end() override { said += "end"; }
  int64_t updates() const override { return made; }
  bool finished() const override { return made >= wanted; }
  const char* unit() const override { return "updates"; }
  uint64_t done() const override { return uint64_t(made); }
  uint64_t total() const override { return uint64_t(wanted); }
  const std::vector<std::string>& columns() const override {
    static const std::vector<std::string> names = {"update"};
    return names;
  }
  std::string report(const Report& report) override {
    said += report.evaluate_episodes ? "evaluate" + std::to_string(report.evaluate_episodes) + " " : "report ";
    EXPECT_GE(report.interval_s, 0);
    EXPECT_GE(report.seconds, report.interval_s);
    report.log.write({double(made)});
    return "";
  }
  Checkpoint checkpoint(bool with_training_state) override {
    said += with_training_state ? "save " : "strip ";
    Checkpoint c;
    c.seed = uint64_t(made);
    return c;
  }
  int64_t made = 0, wanted = 7;
  mutable std::string said;
};

struct LongRunTest : testing::Test {
  LongRunTest() {
    settings.quiet = true;
    settings.output = folder.file("out");
    settings.save = folder.file("save");
    settings.log = folder.file("log");
    settings.evaluate_episodes = 9;
  }
  const TemporaryFolder folder;
  LongRun settings{3, 2};
  Counting work;
};

TEST_F(LongRunTest, ReportsEvaluatesAndSavesAtItsUpdates) {
  settings.evaluate_every = 5;
  settings.strip = true;
  EXPECT_EQ(settings.drive("tool", work), 0);
  EXPECT_EQ(work.said, "begin 1 2 report 3 save 4 report 5 evaluate9 6 report save 7 evaluate9 save endstrip ");
  EXPECT_EQ(contents(settings.log), "update\n2\n4\n5\n6\n7\n");
}

TEST_F(LongRunTest, AFinishedRunIsWrittenAsItIs) {
  work.made = 7;
  EXPECT_EQ(settings.drive("tool", work), 0);
  EXPECT_EQ(work.said, "save endsave ");
  EXPECT_EQ(contents(settings.save), contents(settings.output));
}

// A signal comes in one of its updates.
struct Interrupted : Counting {
  explicit Interrupted(int64_t at) : at(at) {}
  void update(Progress& progress) override {
    Counting::update(progress);
    if (made == at) std::raise(SIGTERM);
  }
  int64_t at;
};

TEST_F(LongRunTest, ASignalInTheLastUpdateLeavesOutNothingOfTheEnd) {
  const auto driven = [&](int64_t at) {
    Interrupted interrupted(at);
    catch_stop_signals();
    const int code = settings.drive("tool", interrupted);
    std::fputs(interrupted.said.c_str(), stderr);
    std::_Exit(code);  // not what removes the folders of other tests
  };
  EXPECT_EXIT(driven(6), testing::ExitedWithCode(128 + SIGTERM), "6 report save save save $");
  EXPECT_EXIT(driven(7), testing::ExitedWithCode(0), "7 report save endsave $");
}

TEST(UpdatesWithin, TheTimeBeforeTheUpdatesCountsButNotInTheirRate) {
  EXPECT_EQ(updates_within(20, 1, 1, 50), 1000);               // 19 s are left at 50 a second
  EXPECT_EQ(updates_within(20, 11, 1, 50), 500);               // 10 s of it went before the first one
  EXPECT_EQ(updates_within(20, 73, 73, 50), 50);               // those are made already
  EXPECT_EQ(updates_within(20, 1.5, 1.5, 1), 13);              // 18.5 s are left for 12.3 more
  EXPECT_EQ(updates_within(1e9, 0, 0, 1), int64_t(1e18) + 1);  // a clock that did not move
}

TEST_F(LongRunTest, OutputsAreFoundBeforeTheWork) {
  settings.output = folder.file("none/out");
  EXPECT_EQ(thrown([&] { settings.drive("tool", work); }).substr(0, 2), "73");
  EXPECT_EQ(work.said, "");
}

}  // namespace
}  // namespace synpo
