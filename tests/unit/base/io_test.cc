#include "base/files/io.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/cli/progress.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/folder.h"
#include "base/files/side_output.h"
#include "base/files/unfinished.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(Input, GivesLines) {
  read_text("one\n\n" + std::string(200000, 'x') + "\nlast", [](Input& input) {
    std::string line;
    EXPECT_TRUE(input.line(line) && line == "one");
    EXPECT_EQ(input.line_number(), 1u);
    EXPECT_EQ(input.offset(), 4u);
    EXPECT_TRUE(input.line(line) && line.empty());
    EXPECT_TRUE(input.line(line) && line == std::string(200000, 'x'));
    EXPECT_TRUE(input.line(line) && line == "last");
    EXPECT_EQ(thrown([&] { input.bad_line("no good"); }), "65 IN: line 4: no good");
    EXPECT_FALSE(input.line(line));
    EXPECT_EQ(input.line_number(), 4u);
    return 0;
  });
}

TEST(Input, LimitsLines) {
  read_text("12345\n123456\n", [](Input& input) {
    std::string line;
    EXPECT_TRUE(input.line(line, 5));
    EXPECT_EQ(thrown([&] { input.line(line, 5); }), "65 IN: line 2: longer than 5 bytes");
    return 0;
  });
  read_text(std::string(100000, 'x'), [](Input& input) {
    std::string line;
    EXPECT_EQ(thrown([&] { input.line(line, 99999); }), "65 IN: line 1: longer than 99999 bytes");
    return 0;
  });
}

TEST(Input, GivesBytes) {
  const std::string text = "abc" + std::string(100000, 'y');
  read_text(text, [&](Input& input) {
    char three[3];
    EXPECT_EQ(input.read(three, 3), 3u);
    EXPECT_EQ(std::string(three, 3), "abc");
    EXPECT_EQ(input.rest(100000), std::string(100000, 'y'));
    EXPECT_EQ(input.offset(), text.size());
    EXPECT_EQ(input.read(three, 3), 0u);
    return 0;
  });
  read_text(text, [](Input& input) {
    EXPECT_EQ(thrown([&] { input.rest(100002); }), "65 IN: longer than 100002 bytes");
    return 0;
  });
}

TEST(Input, NamesWhatCannotBeOpened) {
  const TemporaryFolder folder;
  EXPECT_EQ(thrown([&] { Input input(folder.file("none")); }),
            "66 cannot open '" + folder.file("none") + "': No such file or directory");
  EXPECT_EQ(thrown([&] { Input input(folder.path()); }), "66 cannot open '" + folder.path() + "': it is a folder");
}

TEST(Output, TakesItsNameAtTheEnd) {
  const TemporaryFolder folder;
  const std::string path = folder.file("out", "old");
  Output output(path);
  output.write(std::string(100000, 'n'));
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(folder.files(), 2u);
  output.finish();
  EXPECT_EQ(contents(path), std::string(100000, 'n'));
  EXPECT_EQ(folder.files(), 1u);
}

TEST(Output, LeavesNothingWhenUnfinished) {
  const TemporaryFolder folder;
  try {
    Output output(folder.file("out"));
    output.write(std::string(100000, 'n'));
    throw std::runtime_error("in between");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(Output, AFullDiskIsAnError) {
  EXPECT_EQ(thrown([] { write_file("/dev/full", "x"); }), "74 cannot write '/dev/full': No space left on device");
  EXPECT_EQ(thrown([] {
              Output output("/dev/full");
              output.write(std::string(1 << 20, 'x'));
            }),
            "74 cannot write '/dev/full': No space left on device");
  write_file("/dev/null", "x");
}

TEST(Output, NamesWhatCannotBeMade) {
  const TemporaryFolder folder;
  const std::string path = folder.file("none/out");
  EXPECT_EQ(thrown([&] { Output output(path); }), "73 cannot create '" + path + "': No such file or directory");
  EXPECT_EQ(thrown([&] { Output output(folder.path()); }), "73 cannot create '" + folder.path() + "': Is a directory");
}

namespace fs = std::filesystem;

mode_t rights(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
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

}  // namespace
}  // namespace synpo
