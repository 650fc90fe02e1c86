// A folder of files that appears whole or not at all.
#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace synpo {

class UnfinishedFolder;

// Writes into a temporary folder beside `path` that takes the name in finish(). Unfinished, nothing of it is left. A
// folder that cannot be made, or is there and not empty, is kCantCreate; a full disk kIo.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();

  void write(const std::string& name, std::string_view bytes);
  void finish();

 private:
  std::unique_ptr<UnfinishedFolder> temporary_;
};

}  // namespace synpo
