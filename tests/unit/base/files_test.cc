#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/files/side_output.h"
#include "base/files/unfinished.h"
#include "base/leftovers.h"
#include "base/signals.h"
#include "base/text.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

namespace fs = std::filesystem;

mode_t rights(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

TEST(Destination, FollowsLinksToTheFileThatIsOrWillBe) {
  const TemporaryFolder folder;
  fs::create_directory(folder.file("in"));
  const std::string real = folder.file("in/real", "old");
  fs::create_symlink("in/real", folder.file("link"));
  fs::create_symlink("../link", folder.file("in/chain"));
  fs::create_symlink("missing", folder.file("in/dangling"));
  const Destination found = Destination::find(folder.file("in/chain"));
  EXPECT_EQ(found.kind, Destination::Kind::kFile);
  EXPECT_TRUE(found.exists);
  EXPECT_TRUE(fs::equivalent(found.target, real));
  EXPECT_FALSE(fs::is_symlink(found.target));
  EXPECT_TRUE(found.identity().is(Destination::find(real).identity()));
  EXPECT_FALSE(found.identity().is(Destination::find(folder.file("in/dangling")).identity()));
  const Destination next = Destination::find(folder.file("in/dangling"));
  EXPECT_FALSE(next.exists);
  EXPECT_EQ(next.target, folder.file("in/missing"));
  EXPECT_TRUE(next.identity().is(Destination::find(folder.file("in/../in/missing")).identity()));
}

TEST(Destination, KnowsDevicesAndOpenDescriptors) {
  EXPECT_EQ(Destination::find("-").descriptor, 1);
  EXPECT_EQ(Destination::find("/dev/stdout").descriptor, 1);
  EXPECT_EQ(Destination::find("/dev/stderr").descriptor, 2);
  EXPECT_EQ(Destination::find("/dev/null").kind, Destination::Kind::kInPlace);
  const TemporaryFolder folder;
  const std::string path = folder.file("read", "x");
  const Input input(path);
  EXPECT_EQ(thrown([] { Destination::find("/dev/fd/999"); }),
            "73 cannot write '/dev/fd/999': it is not open for writing");
  EXPECT_EQ(thrown([] { Destination::find(""); }).substr(0, 2), "64");
  for (const char* name : {"", "/.", "/", "/new/"})
    EXPECT_EQ(thrown([&] { Destination::find(folder.path() + name); }),
              "73 cannot create '" + folder.path() + name + "': Is a directory");
}

TEST(Output, WritesWhatALinkNamesAndKeepsItsRights) {
  const TemporaryFolder folder;
  const std::string real = folder.file("real", "old"), link = folder.file("link");
  fs::create_symlink("real", link);
  chmod(real.c_str(), 0640);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(contents(real), "new");
  EXPECT_EQ(rights(real), 0640u);
}

TEST(Output, TakesTheRightsOnlyWhereNobodyElseSeesMoreBefore) {
  const TemporaryFolder folder;
  const std::string path = folder.file("secret", "old");
  chmod(path.c_str(), 0400);
  Output output(path);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    EXPECT_EQ(rights(entry.path()) & 077, 0u) << entry.path();
  output.finish();
  EXPECT_EQ(rights(path), 0400u);
}

TEST(Output, GoesToAnOpenDescriptorAtItsPlace) {
  const TemporaryFolder folder;
  const std::string path = folder.file("file");
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT, 0666));
  ASSERT_TRUE(write_all(file.get(), "before "));
  write_file("/dev/fd/" + std::to_string(file.get()), "between ");
  ASSERT_TRUE(write_all(file.get(), "after"));
  EXPECT_EQ(contents(path), "before between after");
}

TEST(Output, AReaderThatWentAwayIsStopped) {
  prepare_signals();
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  close(ends[0]);
  const Descriptor writing(ends[1]);
  Output output("/dev/fd/" + std::to_string(writing.get()));
  output.write("x");
  int signal = 0;
  try {
    output.finish();
  } catch (const Stopped& stopped) {
    signal = stopped.signal;
  }
  EXPECT_EQ(signal, SIGPIPE);
}

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

TEST(FileUses, RefuseWhatWouldDestroyData) {
  const TemporaryFolder folder;
  const std::string a = folder.file("a", "old"), b = folder.file("b"), link = folder.file("link");
  fs::create_symlink("a", link);
  const FileUses uses;
  { Input input(a); }
  EXPECT_EQ(thrown([&] { Output output(a); }),
            "64 cannot write " + quoted(a) + ": it is read as well, as " + quoted(a));
  EXPECT_EQ(thrown([&] { Output output(link); }),
            "64 cannot write " + quoted(link) + ": it is read as well, as " + quoted(a));
  { Output output(a, Output::Kind::kText, false, {a}); }
  {
    const Output output(b);
    EXPECT_EQ(thrown([&] { Output again(folder.path() + "/./b"); }).substr(0, 2), "64");
    const Output other(b, Output::Kind::kText, false, {b});
  }
  const Output output(b);
  const Output null("/dev/null"), more("/dev/null");
  EXPECT_EQ(contents(a), "old");
}

TEST(FileUses, RefuseToReadWhatIsWritten) {
  const TemporaryFolder folder;
  const std::string a = folder.file("a", "old");
  const FileUses uses;
  const Output output(a);
  EXPECT_EQ(thrown([&] { Input input(a); }), "64 cannot read " + quoted(a) + ": an output goes there, to " + quoted(a));
}

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

TEST(OutputFolder, IsKeptWhereItCannotHaveItsName) {
  const TemporaryFolder folder;
  OutputFolder output(folder.file("x"));
  output.write("1", "one");
  fs::create_directory(folder.file("x"));
  folder.file("x/in the way", "");
  const std::string message = thrown([&] { output.finish(); }), kept = "; it is kept as '";
  EXPECT_TRUE(message.starts_with("73 cannot create the folder '")) << message;
  const size_t at = message.find(kept) + kept.size();
  EXPECT_EQ(contents(message.substr(at, message.size() - at - 1) + "/1"), "one");
}

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

TEST(Text, FaultOfName) {
  for (const char* good : {"map1", "Küche", "a b", "-", "R-B"}) EXPECT_EQ(fault_of_name(good), "") << good;
  EXPECT_EQ(fault_of_name(std::string(255, 'x')), "");
  EXPECT_EQ(fault_of_name(std::string(256, 'x')), "found a name of 256 bytes, expected at most 255");
  EXPECT_EQ(fault_of_name(""), "found an empty name, expected one of 1 to 255 bytes");
  EXPECT_EQ(fault_of_name("caf\xe9"), "found invalid UTF-8 at byte 4 of the name (\\xe9), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("a\tb"), "found a control character at byte 2 of the name (\\x09), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("a\nb\xff"), "found a control character at byte 2 of the name (\\x0a), expected UTF-8 text");
  EXPECT_EQ(fault_of_name("\x7f"), "found a control character at byte 1 of the name (\\x7f), expected UTF-8 text");
}

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
