// Files and standard streams: lines and bytes in, checked and atomic bytes out. `-` is stdin or stdout.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/files/descriptor.h"

namespace synpo {

constexpr Cause kTerminalInput{"input from a terminal"}, kTerminalOutput{"binary output to a terminal"};

// Reads from a file or stdin through a buffer. Errors name the file and the line or the byte. Every function that reads
// throws Stopped when a stop signal has come or comes while it waits (signals.h).
class Input {
 public:
  // Throws kNoInput when the file cannot be opened, kUsage when stdin is a terminal (kTerminalInput), or when the file
  // is written by the same command (file_uses.h).
  explicit Input(const std::string& path);
  // Reads the lines of several files, one after the other, as line() gives them; all are opened here. No path is `-`,
  // which may be there once (kUsage).
  explicit Input(const std::vector<std::string>& paths);
  // Reads from an open descriptor, which stays open; `name` is for messages.
  Input(int fd, std::string name);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  // The next line without its newline (a missing last newline is accepted); false at the end, of the last file where
  // there are several. A line longer than `limit` bytes is an error (kData).
  bool line(std::string& out, size_t limit = 16 << 20);
  // Up to `size` bytes; fewer only at the end of the input.
  size_t read(void* to, size_t size);
  // Everything that is left; more than `limit` bytes is an error (kData).
  std::string rest(size_t limit);

  const std::string& name() const { return name_; }  // for messages: the path, or "standard input"
  std::string whole_name() const;                    // the same, or "the stream of 3 files"
  uint64_t line_number() const { return lines_; }    // of the line returned last, from 1; in its file
  uint64_t offset() const { return offset_; }        // bytes taken so far; of the file

  // Throws kData with "name: line N: ..." in front of the arguments.
  [[noreturn]] void bad_line(const std::string& message) const;
  // The same for an error that was caught.
  [[noreturn]] void bad_line(const Error& error) const;

 private:
  struct Source {
    Descriptor opened;
    int fd;
    std::string name;
  };
  bool fill();
  bool go_on();
  Descriptor opened_;
  int fd_;
  std::string name_;
  std::vector<Source> next_;  // the last one first
  size_t files_ = 1;
  std::vector<char> buffer_;
  size_t begin_ = 0, end_ = 0;
  uint64_t lines_ = 0, offset_ = 0;
};

// Writes to stdout, to a device or a pipe, or to a temporary beside the file, which takes its name in finish(). Links
// are followed, and a file that is there keeps its rights. Unfinished output to a file leaves nothing. A full
// disk is kIo, a file that cannot be made kCantCreate, and so is one whose place no other can take; a reader that went
// away is Stopped with SIGPIPE.
class Output {
 public:
  // A stream is text that a stop signal may end anywhere: where its reader does not read, write() and finish() wait
  // only until one has come, and throw Stopped. What is of another kind waits for its reader whatever comes.
  enum class Kind { kText, kStream, kBinary };
  // Binary output to a terminal is refused (kUsage, kTerminalOutput) unless `force`; so is a file that the command
  // reads or writes already (file_uses.h), but for those of `over`.
  explicit Output(const std::string& path, Kind kind = Kind::kText, bool force = false,
                  const std::vector<std::string>& over = {});
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(std::string_view bytes);
  void flush();
  // Flushes, checks, and gives the file its name.
  void finish();
  // Also as /dev/stdout.
  bool is_stdout() const { return fd_ == 1; }

 private:
  struct Place;
  [[noreturn]] void failed(const char* what);
  std::string path_;
  Kind kind_;
  std::unique_ptr<Place> place_;
  int fd_ = 1;
  std::string buffer_;
};

// Writes `bytes` to `path` as Output does.
void write_file(const std::string& path, std::string_view bytes, Output::Kind kind = Output::Kind::kBinary,
                bool force = false, const std::vector<std::string>& over = {});

}  // namespace synpo
