/* Preloaded, it makes the system fail as FAULT says, which is one of
 *
 *   write:N  the N-th write to a file fails, and all that come next: the disk is full
 *   once:N   the N-th write to a file fails, the next ones do not: somebody made room
 *   sync:N   the N-th fsync fails
 *   short    reads and writes move a few bytes of what they could, and every other one is interrupted first
 *   clock    the clocks jump forward by hours, and that of the day back as well
 *
 * What counts are regular files and memory files, not descriptor 2. FAULT_LOG is a file to which the number of writes
 * and syncs so far is written when the process ends. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static atomic_long writes, syncs, calls, ticks;
static char kind[16];
static long number;

__attribute__((constructor)) static void begin(void) {
  const char* fault = getenv("FAULT");
  if (fault) sscanf(fault, "%15[a-z]:%ld", kind, &number);
}

__attribute__((destructor)) static void end(void) {
  const char* path = getenv("FAULT_LOG");
  FILE* file = path ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld %ld\n", atomic_load(&writes), atomic_load(&syncs));
  fclose(file);
}

static int is(const char* what) { return strcmp(kind, what) == 0; }

static int is_file(int fd) {
  struct stat status;
  return fd != 2 && fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
}

/* Of a call that could move `size` bytes: how many it may; -1 where it is interrupted. */
static ssize_t less(size_t size) {
  const long call = atomic_fetch_add(&calls, 1);
  if (call % 2 == 0) {
    errno = EINTR;
    return -1;
  }
  const size_t some = 1 + (size_t)(call * 7919L % 3001);
  return (ssize_t)(size < some ? size : some);
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int fd, const void* bytes, size_t size) {
  static __typeof__(&write) real;
  if (!real) real = REAL(write);
  if (is("short") && fd != 2 && size > 0) {
    const ssize_t some = less(size);
    return some < 0 ? -1 : real(fd, bytes, (size_t)some);
  }
  if (!is_file(fd)) return real(fd, bytes, size);
  const long now = atomic_fetch_add(&writes, 1) + 1;
  if ((is("write") && now >= number) || (is("once") && now == number)) {
    errno = ENOSPC;
    return -1;
  }
  return real(fd, bytes, size);
}

ssize_t read(int fd, void* bytes, size_t size) {
  static __typeof__(&read) real;
  if (!real) real = REAL(read);
  if (!is("short") || size == 0) return real(fd, bytes, size);
  const ssize_t some = less(size);
  return some < 0 ? -1 : real(fd, bytes, (size_t)some);
}

int fsync(int fd) {
  static __typeof__(&fsync) real;
  if (!real) real = REAL(fsync);
  const long now = atomic_fetch_add(&syncs, 1) + 1;
  if (is("sync") && now == number) {
    errno = EIO;
    return -1;
  }
  return real(fd);
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  static __typeof__(&clock_gettime) real;
  if (!real) real = REAL(clock_gettime);
  const int status = real(clock, time);
  if (!is("clock") || status != 0) return status;
  const long tick = atomic_fetch_add(&ticks, 1);
  if (clock == CLOCK_MONOTONIC)
    time->tv_sec += tick / 5 * 3600; /* it never goes back */
  else if (clock == CLOCK_REALTIME)
    time->tv_sec += (tick % 7 - 3) * 86400;
  return status;
}
