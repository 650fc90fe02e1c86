// The tools that learn for hours have this in common: where they write, after which updates, and the loop itself.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/files/unfinished.h"
#include "engine/device.h"
#include "format/checkpoint.h"
#include "format/run_log.h"

namespace synpo {

class LongWork;

struct LongRun {
  std::string output = "-", save, log;
  std::string resume;  // the checkpoint that the run goes on from; an option of the tool
  uint64_t seed = 1;
  int threads = 0, evaluate_episodes = 100;
  int64_t every, report, evaluate_every = 0;
  bool strip = false, force = false, quiet = false;
  DeviceOptions device;

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

  // Updates until the work is finished or a signal stops it, with a bar on stderr, a log and checkpoints; returns the
  // tool's exit code. Throws what the work and RunOutputs throw, and Stopped where nothing was learned yet.
  int drive(const char* tool, LongWork& work) const;
};

// A run as drive() sees it.
class LongWork {
 public:
  virtual ~LongWork() = default;

  // Called when all outputs have been found to be writable, where there is an update to make. Throws Stopped where a
  // stop signal comes while it waits for data.
  virtual void begin() {}
  // Throws Stopped, and is as it was before, where a stop signal comes while it waits for data.
  virtual void update(Progress& progress) = 0;
  // Waits for what the last update may have left to be computed beside the next one: before a time is taken.
  virtual void settle() {}
  // Called after the last update, unless a signal stopped the run before it. Throws Stopped where a stop signal comes,
  // or has come, while it waits for data.
  virtual void end() {}

  virtual int64_t updates() const = 0;  // all told, with those before a resumption
  virtual bool finished() const = 0;
  virtual bool has_learned() const { return true; }  // so that a run that is stopped has something to save
  // How much is done, and of how much (0: not known), in the unit of the bar.
  virtual const char* unit() const = 0;
  virtual uint64_t done() const = 0;
  virtual uint64_t total() const = 0;

  virtual const std::vector<std::string>& columns() const = 0;  // of the log
  struct Report {
    TsvLog& log;
    Progress& progress;
    double seconds, interval_s;  // since the start, and since the report before
    int evaluate_episodes;       // 0: no evaluation
  };
  // Writes a row of the log; returns what stands beside the bar until the next one.
  virtual std::string report(const Report& report) = 0;
  virtual Checkpoint checkpoint(bool with_training_state) = 0;
};

// A long run writes a checkpoint at its end, one to go on from now and then, and a log.
//
// All three are checked, against one another and against what the command has read, and opened before the work. What
// was learned is worth more than each of them: where one cannot be written the run goes on, and finish() fails.
class RunOutputs {
 public:
  // The place of the checkpoint that the run goes on from may be taken by what holds as much. Throws kUsage where a
  // checkpoint to go on from has no file to be replaced in, kCantCreate where another run saves to that file, and as
  // Output and TsvLog do.
  RunOutputs(const LongRun& settings, const std::vector<std::string>& columns);

  TsvLog& log() { return log_; }
  // Writes settings.save; nothing without it. Hands to `tell` why it could not.
  void save(const Checkpoint& checkpoint, const std::function<void(const std::string&)>& tell = nullptr);
  // Writes settings.output. Throws what save() met first, and kIo where a row of the log got lost.
  void finish(const Checkpoint& checkpoint);

 private:
  std::string save_;
  std::optional<Claim> claim_;     // on save_, where that is a file
  std::vector<std::string> over_;  // what save_ may be one file with
  Output output_;
  TsvLog log_;
  std::optional<Error> lost_;  // why `save` was not written, once or more
};

}  // namespace synpo
