#include "base/files/destination.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "base/files/file_uses.h"
#include "base/files/folder.h"
#include "base/files/io.h"
#include "base/files/side_output.h"
#include "base/files/unfinished.h"
#include "base/leftovers.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

namespace fs = std::filesystem;

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

}  // namespace
}  // namespace synpo
