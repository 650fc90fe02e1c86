#include "base/files/descriptor.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/signals.h"

namespace synpo {
namespace {

bool was_opened_for(int fd, int access) {
  const int flags = fcntl(fd, F_GETFL);
  return flags >= 0 && ((flags & O_ACCMODE) == access || (flags & O_ACCMODE) == O_RDWR);
}

void make_blocking(int fd) { fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK); }

bool is_fifo(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

}  // namespace

Descriptor::~Descriptor() { close(); }

bool Descriptor::close() { return fd_ < 0 || ::close(std::exchange(fd_, -1)) == 0; }

void open_standard_descriptors() {
  for (int fd = 0; fd <= 2; ++fd) {
    if (fcntl(fd, F_GETFD) >= 0) continue;
    // The lowest number that is free is this one.
    if (open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) != fd)
      fail(Exit::kIo, "descriptor ", fd, " is closed, and /dev/null cannot take its place");
  }
}

bool is_readable(int fd) { return was_opened_for(fd, O_RDONLY); }
bool is_writable(int fd) { return was_opened_for(fd, O_WRONLY); }

std::string file_of_descriptor(int fd) {
  struct stat opened, named;
  if (fstat(fd, &opened) != 0 || !S_ISREG(opened.st_mode)) return "";
  std::error_code error;
  const auto path = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(fd), error);
  if (error || stat(path.c_str(), &named) != 0 || named.st_dev != opened.st_dev || named.st_ino != opened.st_ino)
    return "";
  const auto nearer = path.lexically_relative(std::filesystem::current_path(error));
  return error || nearer.empty() || *nearer.begin() == ".." ? path.string() : nearer.string();
}

Descriptor open_to_read(const std::string& path) {
  // To open a pipe would wait for its writer, deaf to signals; so does wait_to_read(), but hears them.
  const bool fifo = is_fifo(path);
  Descriptor opened(open(path.c_str(), O_RDONLY | O_CLOEXEC | (fifo ? O_NONBLOCK : 0)));
  if (opened && fifo) make_blocking(opened.get());
  return opened;
}

void wait_to_read(int fd) {
  stop_if_asked();
  pollfd either[2] = {{fd, POLLIN, 0}, {stop_descriptor(), POLLIN, 0}};
  while (poll(either, 2, -1) < 0 && errno == EINTR) stop_if_asked();
  stop_if_asked();
}

Descriptor open_in_place(const std::string& path) {
  if (!is_fifo(path)) return Descriptor(open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  while (true) {
    Descriptor opened(open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
    if (opened) make_blocking(opened.get());
    if (opened || errno != ENXIO) return opened;
    stop_if_asked();
    // Of a reader that comes nobody tells.
    constexpr int kPause_ms = 50;
    pollfd stop = {stop_descriptor(), POLLIN, 0};
    poll(&stop, 1, kPause_ms);
  }
}

bool write_all(int fd, std::string_view bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t put = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (put > 0) done += size_t(put);
    if (put >= 0 || errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
    pollfd room = {fd, POLLOUT, 0};
    poll(&room, 1, -1);
  }
  return true;
}

bool write_until_stop(int fd, std::string_view bytes) {
  struct stat status;
  if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode)) return write_all(fd, bytes);
  while (!bytes.empty()) {
    pollfd either[2] = {{fd, POLLOUT, 0}, {stop_descriptor(), POLLIN, 0}};
    if (poll(either, 2, -1) < 0) {
      if (errno != EINTR) return false;
      continue;
    }
    if (either[0].revents == 0) {
      errno = EINTR;
      return false;
    }
    // For so many there is room, so that the write does not wait.
    const std::string_view part = bytes.substr(0, PIPE_BUF);
    if (!write_all(fd, part)) return false;
    bytes.remove_prefix(part.size());
  }
  return true;
}

}  // namespace synpo
