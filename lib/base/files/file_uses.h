// Keeps track of the files that one command reads and writes, so that no output destroys an input or another output.
#pragma once
#include <sys/stat.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace synpo {

// Identifies a file, by whatever name: the number of one that is there, and folder and name of one that will be.
struct FileIdentity {
  struct Number {
    dev_t device;
    ino_t inode;
    bool operator==(const Number&) const = default;
  };
  std::optional<Number> file, folder;
  std::string name;
  mode_t type = S_IFREG;

  static FileIdentity of(int fd);
  bool is(const FileIdentity& other) const;
};

// While one lives, inputs and outputs tell it what they open. What would destroy data is kUsage: an output that is a
// file read by the same command, and two outputs at a time that are one file. Of devices nothing is lost.
class FileUses {
 public:
  FileUses();
  ~FileUses();
  FileUses(const FileUses&) = delete;
  FileUses& operator=(const FileUses&) = delete;

 private:
  friend void use_as_input(const std::string& path, const FileIdentity& file);
  friend class OutputUse;
  struct Use {
    std::string path;
    FileIdentity file;
  };
  bool reads_stdin_ = false;
  std::vector<Use> inputs_;                          // of the whole command
  std::vector<std::shared_ptr<const Use>> outputs_;  // those that live
};

// A file is read, from here to the end of the command. `path` is as the user gave it; `-` can be read only once
// (kUsage).
void use_as_input(const std::string& path, const FileIdentity& file);

// A file that is written, as long as this lives. `over` are paths, as they were given, of inputs and outputs that it
// may be one file with, since nothing is lost.
class OutputUse {
 public:
  OutputUse(const std::string& path, const FileIdentity& file, const std::vector<std::string>& over = {});
  OutputUse(OutputUse&&) = default;
  ~OutputUse();

 private:
  std::shared_ptr<const FileUses::Use> use_;
};

}  // namespace synpo
