// File descriptors: closed by their owner, opened and waited for where a signal must be heard.
#pragma once
#include <string>
#include <string_view>
#include <utility>

namespace synpo {

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  // False, with errno, where the last bytes did not get there.
  bool close();

 private:
  int fd_ = -1;
};

// At the start of a tool: opens 0, 1 and 2 where they are closed, so that no file gets one of these numbers. They can
// be neither read nor written.
void open_standard_descriptors();
// Whether a descriptor is open and was opened for this.
bool is_readable(int fd);
bool is_writable(int fd);

// The path of the regular file of a descriptor, from the working directory where it lies below that; "" where there
// is no such file, or none of that name any more.
std::string file_of_descriptor(int fd);

// Opens a file, a device or a pipe to read it; without a writer a pipe is opened too. Empty, with errno, where it
// cannot be opened.
Descriptor open_to_read(const std::string& path);
// Waits until there is something to read, or the end. Throws Stopped if a signal has come or comes first (signals.h).
void wait_to_read(int fd);
// Opens a device or a pipe that is there, to write to it as it is. Waits for the reader of a pipe; throws Stopped if a
// signal comes first. Empty, with errno, where it cannot be opened.
Descriptor open_in_place(const std::string& path);

// False, with errno, where it fails.
bool write_all(int fd, std::string_view bytes);
// The same, but where a pipe, a socket or a terminal takes nothing more it waits only until a stop signal has come
// (signals.h); errno is then EINTR, and some of the bytes may be written.
bool write_until_stop(int fd, std::string_view bytes);

}  // namespace synpo
