#include "learn/long_run.h"

namespace synpo {

void LongRun::add_to(Options& options) {
  options.integer('s', "seed", "N", "seed", seed, 0, INT64_MAX)
      .integer('j', "threads", "N", "threads; 0: as many as there are; results don't depend on it", threads, 0, 1024)
      .text('o', "output", "FILE", "write the checkpoint to FILE", output)
      .text(0, "save", "FILE", "write a checkpoint to FILE now and then, and on SIGINT or SIGTERM", save)
      .integer(0, "every", "N", "updates between two of them", every, 1, INT64_MAX)
      .text(0, "log", "FILE", "run log, TSV; a resumed run continues it", log)
      .integer(0, "report", "N", "updates between two rows of the log", report, 1, INT64_MAX)
      .integer(0, "evaluate-every", "N", "updates between two evaluations on sampled pairs; 0: none", evaluate_every, 0,
               INT64_MAX)
      .integer(0, "evaluate-episodes", "N", "episodes of such an evaluation, for seen and for unseen pairs",
               evaluate_episodes, 1, 1000000)
      .flag(0, "strip", "leave out of the checkpoint what only training needs", strip)
      .flag('f', "force", "write the checkpoint to a terminal", force)
      .flag('q', "quiet", "no progress", quiet);
}

}  // namespace synpo
