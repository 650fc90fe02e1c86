#include "base/cli/progress.h"

#include <gtest/gtest.h>

#include <string>

namespace synpo {
namespace {

TEST(Progress, ShortNumbers) {
  EXPECT_EQ(clock_time(0), "0:00");
  EXPECT_EQ(clock_time(245), "4:05");
  EXPECT_EQ(clock_time(3723), "1:02:03");
  EXPECT_EQ(short_count(512), "512");
  EXPECT_EQ(short_count(0.5), "0.50");
  EXPECT_EQ(short_count(20000), "20.0 k");
  EXPECT_EQ(short_count(1.34e6), "1.3 M");
}

const ProgressFields kTraining = {
    "synpo-train", "updates", 8400, 20000, 3723, 12, "loss 1.234, 5.7 k states/s, pick 90 %"};

TEST(Progress, WithoutColumnsALineHasAllFieldsAndNoBar) {
  EXPECT_EQ(progress_line(kTraining, 0),
            "synpo-train: 42 % of 20.0 k updates, 1:02:03 left, 12/s, loss 1.234, 5.7 k states/s, pick 90 %");
  EXPECT_EQ(progress_line({"synpo-render", "views", 900, 0, -1, 30, ""}, 0), "synpo-render: 900 views, 30/s");
}

TEST(Progress, ANarrowTerminalLosesTheLeastImportantFieldsFirst) {
  const auto at = [](int columns) { return progress_line(kTraining, columns); };
  EXPECT_EQ(at(120),
            "synpo-train: [========            ] 42 % of 20.0 k updates, 1:02:03 left, 12/s, loss 1.234, "
            "5.7 k states/s, pick 90 %");
  EXPECT_EQ(at(99), "synpo-train: [====      ] 42 % of 20.0 k updates, 1:02:03 left, 12/s, loss 1.234, 5.7 k states/s");
  EXPECT_EQ(at(79), "synpo-train: [==   ] 42 % of 20.0 k updates, 1:02:03 left, 12/s, loss 1.234");
  EXPECT_EQ(at(70), "synpo-train: 42 % of 20.0 k updates, 1:02:03 left, 12/s, loss 1.234");
  EXPECT_EQ(at(60), "synpo-train: 42 % of 20.0 k updates, 1:02:03 left, 12/s");
  EXPECT_EQ(at(50), "synpo-train: 42 % of 20.0 k updates, 1:02:03 left");
  EXPECT_EQ(at(40), "synpo-train: 42 %, 1:02:03 left");
  EXPECT_EQ(at(19), "42 %, 1:02:03 left");
  EXPECT_EQ(at(10), "42 %");
  EXPECT_EQ(at(3), "42 ");
}

TEST(Progress, NoLineIsWiderThanTheTerminal) {
  for (int columns = 1; columns < 150; ++columns) {
    EXPECT_LE(progress_line(kTraining, columns).size(), size_t(columns));
    EXPECT_LE(progress_line({"synpo-render", "views", 900, 0, -1, 30, "FloorPlan1, 1 of 19"}, columns).size(),
              size_t(columns));
  }
}

}  // namespace
}  // namespace synpo
