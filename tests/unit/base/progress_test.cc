#include "base/cli/progress.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace synpo
