#include "base/signals.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

#include "base/leftovers.h"

namespace synpo {
namespace {

constexpr int kStopping[] = {SIGHUP, SIGINT, SIGTERM};
// Whatever ends a process that does not handle it.
constexpr int kEnding[] = {SIGHUP,  SIGINT,  SIGQUIT, SIGILL,  SIGTRAP, SIGABRT,   SIGBUS,  SIGFPE,  SIGUSR1,
                           SIGSEGV, SIGUSR2, SIGALRM, SIGTERM, SIGXCPU, SIGVTALRM, SIGPROF, SIGPOLL, SIGSYS};

std::atomic<int> caught{0};
int stop_pipe[2] = {-1, -1};

// In a handler the signal waits until it returns, and then ends the process.
void end(int signal) {
  const int error = errno;
  remove_leftovers();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  errno = error;
}

void note(int signal) {
  int none = 0;
  if (!caught.compare_exchange_strong(none, signal)) return end(signal);
  const int error = errno;
  [[maybe_unused]] const ssize_t put = ::write(stop_pipe[1], "", 1);
  errno = error;
}

// Of a signal that is ignored nothing changes.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) return;
  action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

void prepare_signals() {
  for (const int signal : kEnding) {
    struct sigaction action = {};
    // A checker of memory has handlers of its own.
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_DFL) handle(signal, end);
  }
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

void catch_stop_signals() {
  if (stop_pipe[0] < 0 && pipe2(stop_pipe, O_CLOEXEC | O_NONBLOCK) != 0) stop_pipe[0] = stop_pipe[1] = -1;
  for (const int signal : kStopping) handle(signal, note);
}

int stop_signal() { return caught; }

int stop_descriptor() { return stop_pipe[0]; }

void stop_if_asked() {
  if (caught) throw Stopped{caught};
}

void end_by_signal(int signal) {
  end(signal);
  _exit(128 + signal);
}

}  // namespace synpo
