#include "base/leftovers.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/io.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

namespace fs = std::filesystem;

TEST(Leftovers, AreRemovedWithTheirFiles) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "x"), forgotten = folder.file("forgotten", "x");
  fs::create_directory(folder.file("folder"));
  for (int i = 0; i < 300; ++i) folder.file("folder/a rather long name of a file " + std::to_string(i), "x");
  const Leftover one(file, Leftover::Kind::kFile), two(folder.file("folder"), Leftover::Kind::kFolder);
  { const Leftover three(forgotten, Leftover::Kind::kFile); }
  remove_leftovers();
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_TRUE(fs::exists(forgotten));
}

TEST(Leftovers, MoreThanThereIsRoomForDoNoHarm) {
  std::vector<std::unique_ptr<Leftover>> many;
  for (int i = 0; i < 100; ++i)
    many.push_back(std::make_unique<Leftover>("/nowhere/" + std::to_string(i), Leftover::Kind::kFile));
  const Leftover endless("/" + std::string(100000, 'x'), Leftover::Kind::kFile);
  remove_leftovers();
}

}  // namespace
}  // namespace synpo
