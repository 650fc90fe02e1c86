#include "base/files/io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/files/unfinished.h"
#include "base/signals.h"
#include "base/text.h"

namespace synpo {
namespace {
constexpr size_t kBuffer = 1 << 16;

// Names from files are shown on a terminal, which is not to act on them: what it would is written as \xNN. The colours
// of the programs themselves begin with an escape, which no reader takes in.
std::string fit_for_terminal(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const size_t shown = text[i] == '\n' || text[i] == '\t' || text[i] == '\033' ? 1 : printable_length(text, i);
    out += shown > 0 ? std::string(text.substr(i, shown)) : printable(text.substr(i, 1));
    i += std::max<size_t>(1, shown);
  }
  return out;
}
}  // namespace

Input::Input(int fd, std::string name) : fd_(fd), name_(std::move(name)), buffer_(kBuffer) {}

Input::Input(const std::string& path) : Input(std::vector<std::string>{path}) {}

Input::Input(const std::vector<std::string>& paths) : Input(-1, "") {
  if (std::count(paths.begin(), paths.end(), "-") > 1) fail(Exit::kUsage, "standard input can be read only once");
  for (const std::string& path : paths.empty() ? std::vector<std::string>{"-"} : paths) {
    Source source{{}, STDIN_FILENO, path == "-" ? "standard input" : path};
    if (path == "-") {
      if (isatty(source.fd))
        fail(Exit::kUsage, kTerminalInput, "standard input is a terminal: expected a stream or a file");
      if (!is_readable(source.fd)) fail(Exit::kNoInput, "cannot read standard input: it is not open for reading");
    } else {
      source.opened = open_to_read(path);
      if (!source.opened) fail(Exit::kNoInput, "cannot open '", path, "': ", std::strerror(errno));
      source.fd = source.opened.get();
      struct stat status;
      if (fstat(source.fd, &status) == 0 && S_ISDIR(status.st_mode))
        fail(Exit::kNoInput, "cannot open '", path, "': it is a folder");
    }
    use_as_input(path, FileIdentity::of(source.fd));
    next_.push_back(std::move(source));
  }
  files_ = next_.size();
  std::reverse(next_.begin(), next_.end());
  go_on();
}

// Turns to the next file.
bool Input::go_on() {
  if (next_.empty()) return false;
  opened_ = std::move(next_.back().opened);
  fd_ = next_.back().fd;
  name_ = next_.back().name;
  next_.pop_back();
  lines_ = offset_ = 0;
  return true;
}

std::string Input::whole_name() const { return files_ == 1 ? name_ : concat("the stream of ", files_, " files"); }

bool Input::fill() {
  begin_ = end_ = 0;
  while (true) {
    wait_to_read(fd_);
    const ssize_t got = ::read(fd_, buffer_.data(), buffer_.size());
    if (got > 0) {
      end_ = size_t(got);
      return true;
    }
    if (got == 0) return false;
    if (errno != EINTR && errno != EAGAIN)
      fail(Exit::kIo, "cannot read ", name_, " at byte ", offset_, ": ", std::strerror(errno));
  }
}

bool Input::line(std::string& out, size_t limit) {
  out.clear();
  while (true) {
    if (begin_ == end_ && !fill()) {
      if (!out.empty()) break;
      if (!go_on()) return false;
      continue;
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

// Where the bytes go: stdout, or a device or a pipe that was opened, or a file under way.
struct Output::Place {
  explicit Place(OutputUse given) : use(std::move(given)) {}

  OutputUse use;
  Descriptor opened = {};
  std::unique_ptr<UnfinishedFile> file = {};
  bool is_terminal = false;  // that text goes to
};

Output::Output(const std::string& path, Kind kind, bool force, const std::vector<std::string>& over)
    : path_(path), kind_(kind) {
  const Destination destination = Destination::find(path);
  place_ = std::make_unique<Place>(OutputUse(path, destination.identity(), over));
  switch (destination.kind) {
    case Destination::Kind::kFile:
      destination.check_replaceable();
      place_->file = std::make_unique<UnfinishedFile>(destination);
      fd_ = place_->file->fd();
      return;
    case Destination::Kind::kDescriptor:
      if (destination.descriptor == STDOUT_FILENO) break;
      place_->opened = Descriptor(fcntl(destination.descriptor, F_DUPFD_CLOEXEC, 0));
      break;
    case Destination::Kind::kInPlace:
      place_->opened = open_in_place(path);
  }
  if (destination.descriptor != STDOUT_FILENO) {
    if (!place_->opened) destination.cannot_create(std::strerror(errno));
    fd_ = place_->opened.get();
  }
  place_->is_terminal = kind != Kind::kBinary && isatty(fd_);
  if (kind == Kind::kBinary && !force && isatty(fd_))
    fail(Exit::kUsage, kTerminalOutput, is_stdout() ? "standard output" : "'" + path + "'",
         " is a terminal and the output is binary");
}

Output::~Output() = default;

void Output::failed(const char* what) {
  if (errno == EPIPE) throw Stopped{SIGPIPE};
  if (errno == EINTR) stop_if_asked();
  fail(Exit::kIo, "cannot ", what, " ", is_stdout() ? "standard output" : "'" + path_ + "'", ": ",
       std::strerror(errno));
}

void Output::write(std::string_view bytes) {
  if (place_->is_terminal)
    buffer_ += fit_for_terminal(bytes);
  else
    buffer_.append(bytes);
  if (buffer_.size() >= kBuffer) flush();
}

void Output::flush() {
  const bool written = kind_ == Kind::kStream ? write_until_stop(fd_, buffer_) : write_all(fd_, buffer_);
  if (!written) failed("write");
  buffer_.clear();
}

void Output::finish() {
  flush();
  if (place_->file) place_->file->publish();
  // A full disk may show only here.
  if (!place_->opened.close()) failed("close");
}

void write_file(const std::string& path, std::string_view bytes, Output::Kind kind, bool force,
                const std::vector<std::string>& over) {
  Output output(path, kind, force, over);
  output.write(bytes);
  output.finish();
}

}  // namespace synpo
