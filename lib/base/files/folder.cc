#include "base/files/folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/files/io.h"

namespace synpo {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  const auto failed = [&](const char* why) {
    fail(Exit::kCantCreate, "cannot create the folder '", path_, "': ", why);
  };
  if (path_.empty()) failed("it has no name");
  std::error_code error;
  if (fs::exists(path_, error) && !(fs::is_directory(path_, error) && fs::is_empty(path_, error)))
    failed("it is there already, and not empty");
  const std::string temporary = path_ + ".part" + std::to_string(getpid());
  if (mkdir(temporary.c_str(), 0777) != 0) failed(std::strerror(errno));
  temporary_ = temporary;
}

OutputFolder::~OutputFolder() {
  std::error_code error;
  if (!temporary_.empty()) fs::remove_all(temporary_, error);
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
  write_file(temporary_ + "/" + name, bytes);
}

void OutputFolder::finish() {
  if (rename(temporary_.c_str(), path_.c_str()) != 0)
    fail(Exit::kCantCreate, "cannot create the folder '", path_, "': ", std::strerror(errno));
  temporary_.clear();
}

}  // namespace synpo
