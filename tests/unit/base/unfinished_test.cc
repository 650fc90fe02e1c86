#include "base/files/unfinished.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

namespace fs = std::filesystem;

TEST(UnfinishedFile, IsRemovedByTheNextOneOnceNobodyHoldsIt) {
  const TemporaryFolder folder;
  const std::string target = folder.file("x");
  std::string left;
  {
    // As a killed process leaves it.
    const UnfinishedFile first(Destination::find(target));
    left = folder.file(fs::path(first.path()).filename());
    fs::create_hard_link(left, folder.file("kept"));
    const UnfinishedFile second(Destination::find(target));
    EXPECT_NE(first.path(), second.path());
    EXPECT_EQ(folder.files(), 3u);
  }
  EXPECT_EQ(folder.files(), 1u);
  fs::rename(folder.file("kept"), left);
  folder.file("x.part", "no temporary");
  folder.file("y" + fs::path(left).filename().string(), "another's");
  { const UnfinishedFile other(Destination::find(folder.file("z"))); }
  EXPECT_TRUE(fs::exists(left));
  { const UnfinishedFile same(Destination::find(target)); }
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(folder.files(), 2u);
}

TEST(UnfinishedFile, IsWrittenAgainWhereSomebodyRemovedIt) {
  const TemporaryFolder folder;
  const std::string target = folder.file("x"), whole(200000, 'w');
  UnfinishedFile file(Destination::find(target));
  ASSERT_TRUE(write_all(file.fd(), whole));
  fs::remove(file.path());
  file.publish();
  EXPECT_EQ(contents(target), whole);
  EXPECT_EQ(folder.files(), 1u);
}

TEST(UnfinishedFile, SaysSoWhereItsFolderIsGone) {
  const TemporaryFolder folder;
  fs::create_directory(folder.file("d"));
  UnfinishedFile file(Destination::find(folder.file("d/x")));
  ASSERT_TRUE(write_all(file.fd(), "whole"));
  fs::remove_all(folder.file("d"));
  const std::string message = thrown([&] { file.publish(); });
  EXPECT_TRUE(message.starts_with("74 cannot rename to '")) << message;
  EXPECT_TRUE(message.ends_with("' is gone")) << message;
}

TEST(UnfinishedFile, IsKeptWhereItCannotHaveItsName) {
  const TemporaryFolder folder;
  const std::string target = folder.file("x");
  UnfinishedFile file(Destination::find(target));
  ASSERT_TRUE(write_all(file.fd(), "whole"));
  fs::create_directory(target);
  const std::string message = thrown([&] { file.publish(); }), kept = "; it is kept as '";
  EXPECT_TRUE(message.starts_with("74 cannot rename to '" + target + "': ")) << message;
  const size_t at = message.find(kept) + kept.size();
  const std::string path = message.substr(at, message.size() - at - 1);
  EXPECT_EQ(contents(path), "whole");
  EXPECT_FALSE(path.ends_with(".part"));
  fs::remove(target);
  { const UnfinishedFile same(Destination::find(target)); }
  EXPECT_EQ(contents(path), "whole");
}

}  // namespace
}  // namespace synpo
