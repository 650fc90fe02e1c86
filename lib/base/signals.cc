#include "base/signals.h"

#include <csignal>

namespace synpo {
namespace {
volatile std::sig_atomic_t caught = 0;
void note(int signal) { caught = signal; }
}  // namespace

void catch_stop_signals() {
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = int(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int stop_signal() { return caught; }

void stop_if_asked() {
  if (caught) throw Stopped{caught};
}

}  // namespace synpo
