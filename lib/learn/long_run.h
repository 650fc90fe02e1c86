// What the tools that learn for hours have in common: where they write, and after which updates.
#pragma once
#include "base/cli/options.h"

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

}  // namespace synpo
