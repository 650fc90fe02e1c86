#include "base/files/unfinished.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <vector>

#include "base/error.h"
#include "base/hash.h"

namespace synpo {
namespace {

namespace fs = std::filesystem;

constexpr char kPart[] = ".part", kLock[] = ".lock";
constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyz234567";
constexpr size_t kMark = 4, kRandom = 8, kLongestName = 255;

std::string letters(uint64_t bits, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i, bits >>= 5) text += kLetters[bits & 31];
  return text;
}

// Locks may not reach from one machine to another that shares the folder.
std::string machine_mark() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return letters(Hash().add(std::string(host)).value(), kMark);
}

// The names of a path's temporaries: their folder, and what stands before and after their random letters.
struct Pattern {
  std::string folder, before, after;

  Pattern(const std::string& target, const std::string& ending) : after(kPart + ending) {
    auto [in, name] = split_path(target);
    folder = in;
    before = name.substr(0, kLongestName - after.size() - kRandom - kMark - 1) + "." + machine_mark();
  }
  std::string fresh() const {
    std::random_device random;
    return folder + "/" + before + letters(random(), kRandom - 4) + letters(random(), 4) + after;
  }
  bool fits(const std::string& name) const {
    return name.size() == before.size() + kRandom + after.size() && name.starts_with(before) && name.ends_with(after) &&
           name.find_first_not_of(kLetters, before.size()) == before.size() + kRandom;
  }
};

bool same_file(int fd, const std::string& path) {
  struct stat opened, named;
  return fstat(fd, &opened) == 0 && lstat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

// Removes what a killed process left: what fits and nobody holds.
void clear_abandoned(const Pattern& pattern, mode_t type) {
  std::error_code error;
  for (fs::directory_iterator entry(pattern.folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string path = entry->path().string();
    struct stat status;
    if (!pattern.fits(entry->path().filename().string()) || lstat(path.c_str(), &status) != 0 ||
        (status.st_mode & S_IFMT) != type || status.st_uid != geteuid())
      continue;
    const int access = type == S_IFDIR ? O_RDONLY | O_DIRECTORY : O_RDWR;
    const Descriptor left(open(path.c_str(), access | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!left || flock(left.get(), LOCK_EX | LOCK_NB) != 0 || !same_file(left.get(), path)) continue;
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
}

// Whether another process holds what fits; `own` is not looked at.
bool held_by_another(const Pattern& pattern, const std::string& own) {
  std::error_code error;
  for (fs::directory_iterator entry(pattern.folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!pattern.fits(name) || name == own) continue;
    const Descriptor other(open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (other && flock(other.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) return true;
  }
  return false;
}

// Makes a temporary with `make(path)`, which opens it or sets errno, and holds it. `path` and `leftover` are of the one
// made. Empty, with errno, where it cannot be made.
template <class Make>
Descriptor make_and_hold(const Pattern& pattern, Leftover::Kind kind, Make make, std::string& path,
                         std::optional<Leftover>& leftover) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    path = pattern.fresh();
    // Before it is there, so that no signal comes in between.
    leftover.emplace(path, kind);
    Descriptor made = make(path);
    if (made) {
      while (flock(made.get(), LOCK_EX) != 0 && errno == EINTR) {
      }
      // Another process may have found it before it was held, and removed it.
      if (same_file(made.get(), path)) return made;
    } else if (errno != EEXIST) {
      break;
    }
  }
  const int error = errno;
  leftover.reset();
  errno = error;
  return Descriptor();
}

// A file that somebody removed is still there for who has it open: puts its bytes under that name again.
bool restore(int fd, const std::string& path) {
  struct stat status;
  if (fstat(fd, &status) != 0 || status.st_nlink > 0) return false;
  Descriptor copy(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!copy) return false;
  std::vector<char> part(1 << 16);
  bool whole = true;
  for (off_t at = 0; whole && at < status.st_size;) {
    const ssize_t got = pread(fd, part.data(), part.size(), at);
    whole = got > 0 && write_all(copy.get(), {part.data(), size_t(got)});
    at += got;
  }
  whole = whole && fchmod(copy.get(), status.st_mode & 0777) == 0 && fsync(copy.get()) == 0 && copy.close();
  if (!whole) unlink(path.c_str());
  return whole;
}

// For what cannot have its name: the reason in errno, and the name that it is kept under, which is no temporary's,
// since those are removed by the next run.
std::string keep(const std::string& path, const std::string& ending) {
  const int error = errno;
  std::string kept = path.substr(0, path.size() - ending.size() - std::strlen(kPart)) + ending;
  if (rename(path.c_str(), kept.c_str()) != 0) {
    if (access(path.c_str(), F_OK) != 0) return concat(std::strerror(error), "; its temporary '", path, "' is gone");
    kept = path;
  }
  return concat(std::strerror(error), "; it is kept as '", kept, "'");
}

}  // namespace

UnfinishedFile::UnfinishedFile(const Destination& destination, const std::string& ending)
    : destination_(destination), ending_(ending) {
  const Pattern pattern(destination.target, ending);
  clear_abandoned(pattern, S_IFREG);
  const mode_t rights = destination.exists ? (destination.status.st_mode & 0777) | 0600 : 0666;
  file_ = make_and_hold(
      pattern, Leftover::Kind::kFile,
      [&](const std::string& path) {
        return Descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, rights));
      },
      path_, leftover_);
  if (!file_) destination.cannot_create(std::strerror(errno));
}

UnfinishedFile::~UnfinishedFile() {
  if (leftover_) unlink(path_.c_str());
}

void UnfinishedFile::publish() {
  const auto failed = [&](const char* what) {
    fail(Exit::kIo, "cannot ", what, " '", destination_.path, "': ", std::strerror(errno));
  };
  if (fsync(fd()) != 0 && errno != EINVAL) failed("write");
  if (destination_.exists) {
    // Only root may give a file away.
    [[maybe_unused]] const int owner = fchown(fd(), destination_.status.st_uid, destination_.status.st_gid);
    fchmod(fd(), destination_.status.st_mode & 0777);
  }
  const std::string& target = destination_.target;
  const auto rename_it = [&] { return rename(path_.c_str(), target.c_str()) == 0; };
  const bool renamed = rename_it() || (errno == ENOENT && restore(fd(), path_) && rename_it());
  const std::string kept = renamed ? "" : keep(path_, ending_);
  leftover_.reset();
  if (!renamed) fail(Exit::kIo, "cannot rename to '", destination_.path, "': ", kept);
  if (!sync_folder(split_path(target).folder) || !file_.close()) failed("write");
}

Claim::Claim(const Destination& destination) : mark_(destination, kLock) {
  if (held_by_another(Pattern(destination.target, kLock), split_path(mark_.path()).name))
    destination.cannot_create("another process saves to it");
}

UnfinishedFolder::UnfinishedFolder(const std::string& path, const std::string& target) : path_(path), target_(target) {
  const Pattern pattern(target, "");
  clear_abandoned(pattern, S_IFDIR);
  folder_ = make_and_hold(
      pattern, Leftover::Kind::kFolder,
      [](const std::string& name) {
        if (mkdir(name.c_str(), 0777) != 0) return Descriptor();
        return Descriptor(open(name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
      },
      temporary_, leftover_);
  if (!folder_) fail(Exit::kCantCreate, "cannot create the folder '", path, "': ", std::strerror(errno));
}

UnfinishedFolder::~UnfinishedFolder() {
  std::error_code error;
  if (leftover_) fs::remove_all(temporary_, error);
}

void UnfinishedFolder::write(const std::string& name, std::string_view bytes) {
  Descriptor file(openat(folder_.get(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file || !write_all(file.get(), bytes) || fsync(file.get()) != 0 || !file.close())
    fail(Exit::kIo, "cannot write '", path_, "/", name, "': ", std::strerror(errno));
}

void UnfinishedFolder::publish() {
  const bool renamed = rename(temporary_.c_str(), target_.c_str()) == 0;
  const std::string kept = renamed ? "" : keep(temporary_, "");
  leftover_.reset();
  if (!renamed) fail(Exit::kCantCreate, "cannot create the folder '", path_, "': ", kept);
  if ((fsync(folder_.get()) != 0 && errno != EINVAL) || !sync_folder(split_path(target_).folder))
    fail(Exit::kIo, "cannot write the folder '", path_, "': ", std::strerror(errno));
}

}  // namespace synpo
