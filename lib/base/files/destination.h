// Where an output goes, found out and checked before the work.
#pragma once
#include <sys/stat.h>

#include <string>

#include "base/files/file_uses.h"

namespace synpo {

struct Destination {
  enum class Kind {
    kDescriptor,  // open already: -, /dev/stdout, /dev/fd/3
    kInPlace,     // a device or a pipe, which takes the bytes as they come
    kFile         // a file that is there, or will be
  };
  Kind kind = Kind::kFile;
  std::string path;    // as the user gave it
  std::string target;  // the same with all links followed, as far as they are files
  int descriptor = -1;
  bool exists = false;
  struct stat status = {};  // where it exists

  // Throws kUsage for an empty path, kCantCreate for a folder and for what cannot be looked at. A name that does not
  // exist is a file's, whether its folder does or not.
  static Destination find(const std::string& path);

  // Throws kCantCreate where no other file can take the place of the one that exists: a mount point, one that must not
  // be changed, another user's where only owners may replace.
  void check_replaceable() const;
  FileIdentity identity() const;
  [[noreturn]] void cannot_create(const std::string& why) const;
};

// The folder that a path lies in, and its name there.
struct FolderAndName {
  std::string folder, name;
};
FolderAndName split_path(const std::string& path);
// `path`, and what it links to if it is a link, and so on. Throws kCantCreate for links without an end.
std::string follow_links(const std::string& path);
// Makes sure that the names in a folder reach the disk. False, with errno, where that fails, but not
// for a folder or a system that does not allow it.
bool sync_folder(const std::string& folder);

}  // namespace synpo
