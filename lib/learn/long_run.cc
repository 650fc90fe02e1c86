#include "learn/long_run.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/files/destination.h"
#include "base/signals.h"

namespace synpo {
namespace {

using Paths = std::vector<std::string>;

// The checkpoint to go on from may be one file with these: the one that it follows, and the last one if that holds all.
Paths as_good(const LongRun& settings) {
  Paths paths = {settings.resume};
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
  options.seed(seed).threads(threads);
  device.add_to(options);
  options.text('o', "output", "FILE", "write the checkpoint to FILE", output)
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
      .quiet(quiet);
}

int LongRun::drive(const char* tool, LongWork& work) const {
  // Made before the training, so that hours of it don't end in "cannot create".
  RunOutputs outputs(*this, work.columns());
  try {
    if (!work.finished()) work.begin();
  } catch (const Stopped&) {
    if (!work.has_learned()) throw;
  }
  {
    Progress progress(tool, work.unit(), work.total(), quiet, work.done());
    const TimePoint start = now();
    TimePoint reported = start;
    std::string note;
    const auto tell = [&](const std::string& trouble) { progress.say(trouble + ": the run goes on"); };
    while (!work.finished() && stop_signal() == 0) {
      try {
        work.update(progress);
      } catch (const Stopped&) {
        break;
      }
      progress.set_total(work.total());
      const int64_t update = work.updates();
      const bool last = work.finished();
      if (reports(update, last)) {
        work.settle();
        const TimePoint moment = now();
        note = work.report({outputs.log(), progress, seconds_between(start, moment), seconds_between(reported, moment),
                            evaluates(update, last) ? evaluate_episodes : 0});
        reported = now();
      }
      if (saves(update, last)) outputs.save(work.checkpoint(true), tell);
      progress.update(work.done(), note);
    }
  }
  const int signal = stop_signal();
  if (!work.has_learned()) stop_if_asked();
  if (!save.empty()) outputs.save(work.checkpoint(true));
  bool cut_short = signal != 0 && !work.finished();
  try {
    if (!cut_short) work.end();
  } catch (const Stopped&) {
    cut_short = true;
  }
  outputs.finish(work.checkpoint(!strip));
  return cut_short ? 128 + stop_signal() : 0;
}

RunOutputs::RunOutputs(const LongRun& settings, const std::vector<std::string>& columns)
    : save_(settings.save), over_(as_good(settings)), output_(settings.output, Output::Kind::kBinary, settings.force,
                                                              settings.strip ? Paths{} : Paths{settings.resume}),
      log_(settings.log, !settings.resume.empty(), columns) {
  check_save(save_, over_);
  if (save_.empty()) return;
  const Destination place = Destination::find(save_);
  if (place.kind == Destination::Kind::kFile) claim_.emplace(place);
}

void RunOutputs::save(const Checkpoint& checkpoint, const std::function<void(const std::string&)>& tell) {
  if (save_.empty()) return;
  try {
    write_file(save_, format_checkpoint(checkpoint), Output::Kind::kBinary, true, over_);
  } catch (const Error& error) {
    if (tell) tell(error.what());
    if (!lost_) lost_ = error;
  }
}

void RunOutputs::finish(const Checkpoint& checkpoint) {
  output_.write(format_checkpoint(checkpoint));
  output_.finish();
  if (lost_) throw *lost_;
  log_.check();
}

}  // namespace synpo
