// SIGINT and SIGTERM as a flag that long loops read between two updates.
#pragma once

namespace synpo {

// From now on the two signals set the flag; a second one kills as usual.
void catch_stop_signals();
// 0, or the signal that came.
int stop_signal();

// Thrown where there is nothing to save; run_tool() turns it into the exit code 128 + signal, without a message.
struct Stopped {
  int signal;
};
// Throws Stopped if a signal came.
void stop_if_asked();

}  // namespace synpo
