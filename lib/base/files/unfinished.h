// Files and folders under way: beside the one whose place they will take, under names that cannot be guessed, gone
// whichever way the process ends but by SIGKILL.
//
// Temporaries of x are named x.MMMMRRRRRRRR.part: a mark of the machine, and at random. Whoever makes one holds a lock
// on it, and removes those of the same x, machine and user that nobody holds any more.
#pragma once
#include <optional>
#include <string>

#include "base/files/descriptor.h"
#include "base/files/destination.h"
#include "base/leftovers.h"

namespace synpo {

class UnfinishedFile {
 public:
  // Has the rights, and as far as possible the owner, of the file that it will replace. `ending` ends its name. Throws
  // kCantCreate.
  explicit UnfinishedFile(const Destination& destination, const std::string& ending = "");
  // Removes it, unless published.
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  int fd() const { return file_.get(); }
  const std::string& path() const { return path_; }
  // Flushed to the disk, it takes the destination's name, even if somebody has removed it. Throws kIo; where it cannot
  // have the name it is kept under another, which the message tells.
  void publish();

 private:
  Destination destination_;
  std::string ending_, path_;
  std::optional<Leftover> leftover_;
  Descriptor file_;
};

// The right to write a file again and again: of this machine's processes one at a time has it, and whoever dies loses
// it. It is an empty file beside the other, named as a temporary and with ".lock" after that.
class Claim {
 public:
  // Throws kCantCreate where another process has it. Of two that ask at the same moment perhaps neither gets it.
  explicit Claim(const Destination& destination);

 private:
  UnfinishedFile mark_;
};

class UnfinishedFolder {
 public:
  // `target` is a path without links, `path` the same as the user gave it. Throws kCantCreate.
  UnfinishedFolder(const std::string& path, const std::string& target);
  ~UnfinishedFolder();
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  // A new file in it. Throws kIo.
  void write(const std::string& name, std::string_view bytes);
  // Takes the target's name, where there is nothing or an empty folder. Throws kCantCreate.
  void publish();

 private:
  std::string path_, target_, temporary_;
  std::optional<Leftover> leftover_;
  Descriptor folder_;
};

}  // namespace synpo
