#include "base/files/folder.h"

#include <filesystem>

#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/unfinished.h"

namespace synpo {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path) {
  std::string shown = path;
  while (shown.size() > 1 && shown.back() == '/') shown.pop_back();
  const auto failed = [&](const char* why) {
    fail(Exit::kCantCreate, "cannot create the folder '", shown, "': ", why);
  };
  if (shown.empty()) failed("it has no name");
  if (shown == "-") fail(Exit::kUsage, "a folder cannot go to standard output: expected its name, found '-'");
  const std::string target = follow_links(shown);
  std::error_code error;
  if (fs::exists(target, error) && !(fs::is_directory(target, error) && fs::is_empty(target, error)))
    failed("it is there already, and not empty");
  temporary_ = std::make_unique<UnfinishedFolder>(shown, target);
}

OutputFolder::~OutputFolder() = default;

void OutputFolder::write(const std::string& name, std::string_view bytes) { temporary_->write(name, bytes); }

void OutputFolder::finish() { temporary_->publish(); }

}  // namespace synpo
