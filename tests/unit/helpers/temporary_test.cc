#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/files/unfinished.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

// Of the tests themselves: one that ends must not take another's files along.
TEST(TemporaryFolder, TwoAtATimeAreApart) {
  const TemporaryFolder outer;
  std::string gone;
  outer.file("kept", "outer");
  {
    const TemporaryFolder inner;
    gone = inner.path();
    EXPECT_NE(inner.path(), outer.path());
    EXPECT_EQ(inner.files(), 0u);
    inner.file("kept", "inner");
    EXPECT_EQ(contents(outer.file("kept")), "outer");
  }
  EXPECT_FALSE(std::filesystem::exists(gone));
  EXPECT_EQ(contents(outer.file("kept")), "outer");
}

}  // namespace
}  // namespace synpo
