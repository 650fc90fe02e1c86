#include "base/leftovers.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstring>

namespace synpo {
namespace {

enum State { kFree, kInTheMaking, kFile, kFolder };

struct Slot {
  std::atomic<int> state{kFree};
  char path[PATH_MAX];
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");
Slot slots[32];

// readdir() may take memory, which a signal handler must not.
void remove_folder(const char* path) {
  const int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return;
  alignas(dirent64) char entries[4096];
  for (long size; (size = syscall(SYS_getdents64, fd, entries, sizeof entries)) > 0;)
    for (long at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(entries + at);
      unlinkat(fd, entry->d_name, 0);
      at += entry->d_reclen;
    }
  close(fd);
  rmdir(path);
}

}  // namespace

Leftover::Leftover(const std::string& path, Kind kind) : slot_(-1) {
  if (path.size() >= sizeof slots[0].path) return;
  for (Slot& slot : slots) {
    int free = kFree;
    if (!slot.state.compare_exchange_strong(free, kInTheMaking)) continue;
    std::memcpy(slot.path, path.c_str(), path.size() + 1);
    slot.state = kind == Kind::kFile ? kFile : kFolder;
    slot_ = int(&slot - slots);
    return;
  }
}

Leftover::~Leftover() {
  if (slot_ >= 0) slots[slot_].state = kFree;
}

void remove_leftovers() {
  for (Slot& slot : slots) {
    if (slot.state == kFile) unlink(slot.path);
    if (slot.state == kFolder) remove_folder(slot.path);
  }
}

}  // namespace synpo
