#include "base/files/io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace synpo {
namespace {
constexpr size_t kBuffer = 1 << 16;
}

Input::Input(const std::string& path) : fd_(0), name_("standard input"), buffer_(kBuffer) {
  if (path == "-") {
    if (isatty(0)) fail(Exit::kUsage, kTerminalInput, "standard input is a terminal: expected a stream or a file");
    return;
  }
  name_ = path;
  fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd_ < 0) fail(Exit::kNoInput, "cannot open '", path, "': ", std::strerror(errno));
  struct stat status;
  if (fstat(fd_, &status) == 0 && S_ISDIR(status.st_mode)) {
    close(fd_);
    fail(Exit::kNoInput, "cannot open '", path, "': it is a folder");
  }
}

Input::~Input() {
  if (fd_ > 0) close(fd_);
}

bool Input::fill() {
  begin_ = end_ = 0;
  while (true) {
    const ssize_t got = ::read(fd_, buffer_.data(), buffer_.size());
    if (got > 0) {
      end_ = size_t(got);
      return true;
    }
    if (got == 0) return false;
    if (errno != EINTR) fail(Exit::kIo, "cannot read ", name_, " at byte ", offset_, ": ", std::strerror(errno));
  }
}

bool Input::line(std::string& out, size_t limit) {
  out.clear();
  while (true) {
    if (begin_ == end_ && !fill()) {
      if (out.empty()) return false;
      break;
    }
    const char* start = buffer_.data() + begin_;
    const auto* newline = static_cast<const char*>(std::memchr(start, '\n', end_ - begin_));
    const size_t taken = newline ? size_t(newline - start) : end_ - begin_;
    if (out.size() + taken > limit) fail(Exit::kData, name_, ": line ", lines_ + 1, ": longer than ", limit, " bytes");
    out.append(start, taken);
    begin_ += taken + (newline ? 1 : 0);
    offset_ += taken + (newline ? 1 : 0);
    if (newline) break;
  }
  ++lines_;
  return true;
}

size_t Input::read(void* to, size_t size) {
  size_t done = 0;
  while (done < size && (begin_ < end_ || fill())) {
    const size_t part = std::min(size - done, end_ - begin_);
    std::memcpy(static_cast<char*>(to) + done, buffer_.data() + begin_, part);
    begin_ += part;
    done += part;
  }
  offset_ += done;
  return done;
}

std::string Input::rest(size_t limit) {
  std::string out;
  while (begin_ < end_ || fill()) {
    if (out.size() + (end_ - begin_) > limit) fail(Exit::kData, name_, ": longer than ", limit, " bytes");
    out.append(buffer_.data() + begin_, end_ - begin_);
    offset_ += end_ - begin_;
    begin_ = end_;
  }
  return out;
}

void Input::bad_line(const std::string& message) const { bad_line(Error(Exit::kData, message)); }

void Input::bad_line(const Error& error) const { throw error.at(concat(name_, ": line ", lines_, ": ")); }

Output::Output(const std::string& path, Kind kind, bool force) : path_(path), fd_(1) {
  if (is_stdout()) {
    if (kind == Kind::kBinary && !force && isatty(1))
      fail(Exit::kUsage, kTerminalOutput, "standard output is a terminal and the output is binary");
    return;
  }
  struct stat status;
  if (stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    // A device or a pipe takes the bytes as they come; a name beside it would be of no use.
    fd_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    // One process may have two outputs of one name.
    const std::string stem = path + ".part" + std::to_string(getpid());
    for (int i = 0; i < 100; ++i) {
      temporary_ = i ? stem + "-" + std::to_string(i) : stem;
      fd_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd_ >= 0 || errno != EEXIST) break;
    }
  }
  if (fd_ < 0) {
    temporary_.clear();
    fail(Exit::kCantCreate, "cannot create '", path, "': ", std::strerror(errno));
  }
}

Output::~Output() {
  if (fd_ > 1) close(fd_);
  if (!finished_ && !temporary_.empty()) unlink(temporary_.c_str());
}

void Output::failed(const char* what) {
  fail(Exit::kIo, "cannot ", what, " ", is_stdout() ? "standard output" : "'" + path_ + "'", ": ",
       std::strerror(errno));
}

void Output::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBuffer) flush();
}

void Output::flush() {
  size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t put = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (put < 0 && errno != EINTR) failed("write");
    if (put > 0) done += size_t(put);
  }
  buffer_.clear();
}

void Output::finish() {
  flush();
  if (temporary_.empty()) {
    // A full disk may show only here.
    if (fd_ == 1 ? false : close(std::exchange(fd_, -1)) != 0) failed("close");
    finished_ = true;
    return;
  }
  if (fsync(fd_) != 0 && errno != EINVAL) failed("write");
  if (close(std::exchange(fd_, -1)) != 0) failed("close");
  if (rename(temporary_.c_str(), path_.c_str()) != 0) failed("rename to");
  finished_ = true;
}

void write_file(const std::string& path, std::string_view bytes, Output::Kind kind, bool force) {
  Output output(path, kind, force);
  output.write(bytes);
  output.finish();
}

}  // namespace synpo
