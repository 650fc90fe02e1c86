#include "base/files/destination.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "base/files/descriptor.h"

namespace synpo {
namespace {

constexpr int kMostLinks = 40;

// Where a link leads; empty for what is no link.
std::string link_target(const std::string& path) {
  char target[PATH_MAX];
  const ssize_t size = readlink(path.c_str(), target, sizeof target);
  if (size <= 0) return "";
  const std::string to(target, size_t(size));
  return to[0] == '/' ? to : split_path(path).folder + "/" + to;
}

// The number in the path of an open descriptor of this process, such as /dev/fd/3, or -1.
int own_descriptor(const std::string& path) {
  const auto [folder, name] = split_path(path);
  if (name.empty() || name.size() > 6 || name.find_first_not_of("0123456789") != std::string::npos) return -1;
  char real[PATH_MAX];
  if (!realpath(folder.c_str(), real) || real != "/proc/" + std::to_string(getpid()) + "/fd") return -1;
  return std::stoi(name);
}

// Calls `visit` for the path and for all that it links to, one after the other, until that returns true.
template <class Visit>
void for_links(const std::string& path, Visit visit) {
  std::string at = path;
  for (int links = 0; !at.empty() && !visit(at); ++links) {
    if (links == kMostLinks) fail(Exit::kCantCreate, "cannot create '", path, "': ", std::strerror(ELOOP));
    at = link_target(at);
  }
}

}  // namespace

FolderAndName split_path(const std::string& path) {
  const size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {path.substr(0, std::max<size_t>(slash, 1)), path.substr(slash + 1)};
}

std::string follow_links(const std::string& path) {
  std::string last = path;
  for_links(path, [&](const std::string& at) {
    last = at;
    return false;
  });
  return last;
}

bool sync_folder(const std::string& folder) {
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return !opened || fsync(opened.get()) == 0 || errno != EIO;
}

Destination Destination::find(const std::string& path) {
  Destination found;
  found.path = found.target = path;
  if (path.empty()) fail(Exit::kUsage, "an output has an empty name: expected a file, or - for standard output");
  if (path == "-")
    found.descriptor = STDOUT_FILENO;
  else
    for_links(path, [&](const std::string& at) {
      found.target = at;
      found.descriptor = own_descriptor(at);
      return found.descriptor >= 0;
    });
  if (found.descriptor >= 0) {
    found.kind = Kind::kDescriptor;
    if (!is_writable(found.descriptor))
      fail(Exit::kCantCreate, "cannot write ", path == "-" ? "standard output" : "'" + path + "'",
           ": it is not open for writing");
    found.exists = fstat(found.descriptor, &found.status) == 0;
    return found;
  }
  // The kernel follows the links once more, by its own rules for folders that everybody may write to.
  const Descriptor seen(open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!seen && errno != ENOENT) found.cannot_create(std::strerror(errno));
  found.exists = seen && fstat(seen.get(), &found.status) == 0;
  const std::string name = split_path(found.target).name;
  if ((found.exists && S_ISDIR(found.status.st_mode)) || name.empty() || name == "." || name == "..")
    found.cannot_create(std::strerror(EISDIR));
  if (found.exists && !S_ISREG(found.status.st_mode)) {
    found.kind = Kind::kInPlace;
    return found;
  }
  struct stat target;
  if (found.exists && (lstat(found.target.c_str(), &target) != 0 || target.st_ino != found.status.st_ino ||
                       target.st_dev != found.status.st_dev))
    found.cannot_create("it is no file that has a name");
  return found;
}

void Destination::check_replaceable() const {
  if (!exists) return;
  struct statx more = {};
  if (statx(AT_FDCWD, target.c_str(), AT_SYMLINK_NOFOLLOW, STATX_BASIC_STATS, &more) == 0) {
    if (more.stx_attributes & STATX_ATTR_MOUNT_ROOT)
      cannot_create("something is mounted there, so no other file can take its place");
    if (more.stx_attributes & (STATX_ATTR_IMMUTABLE | STATX_ATTR_APPEND))
      cannot_create("the file there is marked as one that must not be replaced");
  }
  struct stat folder;
  const uid_t user = geteuid();
  if (stat(split_path(target).folder.c_str(), &folder) == 0 && (folder.st_mode & S_ISVTX) && user != 0 &&
      user != status.st_uid && user != folder.st_uid)
    cannot_create("the file there is another user's, and in its folder only the owner may replace it");
}

FileIdentity Destination::identity() const {
  FileIdentity identity;
  if (exists) {
    identity.file = FileIdentity::Number{status.st_dev, status.st_ino};
    identity.type = status.st_mode & S_IFMT;
  }
  if (kind != Kind::kFile) return identity;
  const auto [folder, name] = split_path(target);
  struct stat there;
  if (stat(folder.c_str(), &there) == 0) identity.folder = FileIdentity::Number{there.st_dev, there.st_ino};
  identity.name = name;
  return identity;
}

void Destination::cannot_create(const std::string& why) const {
  fail(Exit::kCantCreate, "cannot create '", path, "': ", why);
}

}  // namespace synpo
