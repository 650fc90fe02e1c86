#include "base/files/file_uses.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {

// Of the one command of this process.
FileUses* uses = nullptr;

std::string shown(const std::string& path) { return path == "-" ? "a standard stream" : quoted(path); }

}  // namespace

FileIdentity FileIdentity::of(int fd) {
  FileIdentity identity;
  struct stat status;
  if (fstat(fd, &status) == 0) {
    identity.file = Number{status.st_dev, status.st_ino};
    identity.type = status.st_mode & S_IFMT;
  }
  return identity;
}

bool FileIdentity::is(const FileIdentity& other) const {
  return (file && file == other.file) || (folder && folder == other.folder && name == other.name);
}

FileUses::FileUses() { uses = this; }
FileUses::~FileUses() { uses = nullptr; }

void use_as_input(const std::string& path, const FileIdentity& file) {
  if (!uses) return;
  if (path == "-" && std::exchange(uses->reads_stdin_, true))
    fail(Exit::kUsage, "standard input can be read only once");
  if (file.type != S_IFREG) return;
  for (const auto& output : uses->outputs_)
    if (output->file.is(file))
      fail(Exit::kUsage, "cannot read ", shown(path), ": an output goes there, to ", shown(output->path));
  uses->inputs_.push_back({path, file});
}

OutputUse::OutputUse(const std::string& path, const FileIdentity& file, const std::vector<std::string>& over) {
  if (!uses || file.type == S_IFCHR) return;
  const auto clashes = [&](const FileUses::Use& use) {
    return use.file.is(file) && std::find(over.begin(), over.end(), use.path) == over.end();
  };
  for (const FileUses::Use& input : uses->inputs_)
    if (clashes(input))
      fail(Exit::kUsage, "cannot write ", shown(path), ": it is read as well, as ", shown(input.path));
  for (const auto& output : uses->outputs_)
    if (clashes(*output))
      fail(Exit::kUsage, "cannot write ", shown(path), ": another output goes there, to ", shown(output->path));
  use_ = std::make_shared<const FileUses::Use>(FileUses::Use{path, file});
  uses->outputs_.push_back(use_);
}

OutputUse::~OutputUse() {
  if (use_ && uses) std::erase(uses->outputs_, use_);
}

}  // namespace synpo
