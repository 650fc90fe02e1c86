#include "base/files/file_uses.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/files/destination.h"
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

}  // namespace
}  // namespace synpo
