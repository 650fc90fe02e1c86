// What the tools that learn for hours have in common: where they write, and after which updates.
#pragma once
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/files/io.h"
#include "format/checkpoint.h"
#include "format/run_log.h"

namespace synpo {

struct LongRun {
  std::string output = "-", save, log;
  int64_t seed = 1, threads = 0, every, report, evaluate_every = 0, evaluate_episodes = 100;
  bool strip = false, force = false, quiet = false;

  // Defaults of --every and --report.
  LongRun(int64_t every, int64_t report) : every(every), report(report) {}
  void add_to(Options& options);

  // Whether update number `update`, perhaps the last one, is followed by an evaluation, a row of the log (with every
  // evaluation there is one), a checkpoint in `save` (the last one is not: it goes to `output`).
  bool evaluates(int64_t update, bool last) const {
    return evaluate_every > 0 && (update % evaluate_every == 0 || last);
  }
  bool reports(int64_t update, bool last) const { return update % report == 0 || last || evaluates(update, last); }
  bool saves(int64_t update, bool last) const { return !save.empty() && update % every == 0 && !last; }
};

// What a long run writes: a checkpoint at its end, one to go on from now and then, a log.
//
// All three are checked, against one another and against what the command has read, and opened before the work. The
// training state is worth more than the log: where that cannot be written the run goes on, and finish() fails.
class RunOutputs {
 public:
  // `resumed` is the checkpoint that the run goes on from, if any: its place may be taken by what holds as much. Throws
  // kUsage where a checkpoint to go on from has no file to be replaced in, and as Output and TsvLog do.
  RunOutputs(const LongRun& settings, const std::string& resumed, const std::vector<std::string>& columns);

  TsvLog& log() { return log_; }
  // Writes settings.save; nothing without it.
  void save(const Checkpoint& checkpoint) const;
  // Writes settings.output. Throws kIo where a row of the log got lost.
  void finish(const Checkpoint& checkpoint);

 private:
  std::string save_;
  std::vector<std::string> over_;  // what save_ may be one file with
  Output output_;
  TsvLog log_;
};

}  // namespace synpo
