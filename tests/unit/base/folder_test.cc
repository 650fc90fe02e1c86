#include "base/files/folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/io.h"
#include "base/files/side_output.h"
#include "base/files/unfinished.h"
#include "base/parallel.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(OutputFolder, IsWholeOrNotThere) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pictures");
  { OutputFolder(path).write("1", "one"); }
  EXPECT_EQ(folder.files(), 0u);
  OutputFolder output(path + "/");
  output.write("1", "one");
  output.write("2", "two");
  EXPECT_FALSE(std::filesystem::exists(path));
  output.finish();
  EXPECT_EQ(contents(path + "/1") + contents(path + "/2"), "onetwo");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(OutputFolder, TakesTheNameOfAnEmptyFolderAndOfNothingElse) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("empty"));
  OutputFolder output(folder.file("empty"));
  output.write("1", "one");
  output.finish();
  folder.file("file", "text");
  for (const std::string& path : {folder.file("empty"), folder.file("file"), folder.file("missing/x"), std::string()}) {
    try {
      OutputFolder refused(path);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::kCantCreate) << path;
    }
  }
  EXPECT_EQ(folder.files(), 2u);
}

namespace fs = std::filesystem;

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

}  // namespace
}  // namespace synpo
