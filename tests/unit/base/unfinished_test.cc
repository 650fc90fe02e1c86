#include "base/files/unfinished.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
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

TEST(Claim, IsOneProcessesUntilThatDies) {
  const TemporaryFolder folder;
  const Destination target = Destination::find(folder.file("x"));
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const Claim claim(target);
    [[maybe_unused]] const bool ready = write_all(told[1], "!");
    pause();
    _exit(0);
  }
  char byte;
  ASSERT_EQ(read(told[0], &byte, 1), 1);
  const std::string refused = "73 cannot create '" + target.path + "': another process saves to it";
  EXPECT_EQ(thrown([&] { const Claim claim(target); }), refused);
  EXPECT_EQ(folder.files(), 1u);
  { const Claim other(Destination::find(folder.file("y"))); }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(folder.files(), 1u);
  const Claim claim(target);
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_EQ(thrown([&] { const Claim second(target); }), refused);
}

}  // namespace
}  // namespace synpo
