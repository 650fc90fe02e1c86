#include "learn/long_run.h"

#include "base/error.h"
#include "base/files/destination.h"

namespace synpo {
namespace {

using Paths = std::vector<std::string>;

// What the checkpoint to go on from may be one file with: the one that it follows, and the last one if that holds all.
Paths as_good(const LongRun& settings, const std::string& resumed) {
  Paths paths = {resumed};
  if (!settings.strip && settings.output != "-") paths.push_back(settings.output);
  return paths;
}

void check_save(const std::string& path, const Paths& over) {
  if (path.empty()) return;
  const Destination place = Destination::find(path);
  if (place.kind == Destination::Kind::kDescriptor || S_ISFIFO(place.status.st_mode) || S_ISSOCK(place.status.st_mode))
    fail(Exit::kUsage, "cannot save to ", quoted(path), " what a run can go on from: expected a file");
  Output probe(path, Output::Kind::kBinary, true, over);
}

}  // namespace

void LongRun::add_to(Options& options) {
  options.integer('s', "seed", "N", "seed", seed, 0, INT64_MAX)
      .integer('j', "threads", "N", "threads; 0: as many as there are; results don't depend on it", threads, 0, 1024)
      .text('o', "output", "FILE", "write the checkpoint to FILE", output)
      .text(0, "save", "FILE", "write a checkpoint to FILE now and then, and when a signal stops the run", save)
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

RunOutputs::RunOutputs(const LongRun& settings, const std::string& resumed, const std::vector<std::string>& columns)
    : save_(settings.save), over_(as_good(settings, resumed)),
      output_(settings.output, Output::Kind::kBinary, settings.force, settings.strip ? Paths{} : Paths{resumed}),
      log_(settings.log, !resumed.empty(), columns) {
  check_save(save_, over_);
}

void RunOutputs::save(const Checkpoint& checkpoint) const {
  if (!save_.empty()) write_file(save_, format_checkpoint(checkpoint), Output::Kind::kBinary, true, over_);
}

void RunOutputs::finish(const Checkpoint& checkpoint) {
  output_.write(format_checkpoint(checkpoint));
  output_.finish();
  log_.check();
}

}  // namespace synpo
