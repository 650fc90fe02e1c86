// Signals: those that ask a tool to stop, as a flag that long loops read between two updates; those that end it, which
// leave no temporary file; and a reader that went away.
#pragma once

namespace synpo {

// At the start of a tool. A signal that ends the process removes its temporaries first (leftovers.h). SIGPIPE and
// SIGXFSZ do not: the write fails instead. What was ignored at the start stays so, as in scripts' commands with &.
void prepare_signals();

// From now on SIGHUP, SIGINT and SIGTERM, unless they were ignored at the start, set the flag. A second one, of
// whatever kind of the three, ends the process.
void catch_stop_signals();
// 0, or the signal that came first.
int stop_signal();
// Can be read as soon as a signal has come, for poll(); -1 before catch_stop_signals().
int stop_descriptor();

// Thrown where there is nothing to save: by a signal that came, or with SIGPIPE where the reader of an output went
// away. run_tool() turns it into the exit code 128 + signal, without a message.
struct Stopped {
  int signal;
};
// Throws Stopped if a signal came.
void stop_if_asked();

// Removes temporaries and ends the process as the signal does.
[[noreturn]] void end_by_signal(int signal);

}  // namespace synpo
