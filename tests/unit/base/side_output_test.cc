#include "base/files/side_output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/files/unfinished.h"
#include "helpers/table_helpers.h"

namespace synpo {
namespace {

TEST(SideOutput, TellsAtTheEndWhatWentWrong) {
  SideOutput full("/dev/full");
  for (int i = 0; i < 10; ++i) full.write(std::string(100000, 'x'));
  full.finish();
  EXPECT_EQ(thrown([&] { full.check(); }), "74 cannot write '/dev/full': No space left on device");
  SideOutput fine("/dev/null");
  fine.write("x");
  fine.finish();
  fine.check();
}

}  // namespace
}  // namespace synpo
