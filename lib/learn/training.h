// A training by imitation from its settings to its end: where it begins, how long it lasts, its stream, its reports.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cli/progress.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/parallel.h"
#include "format/checkpoint.h"
#include "format/run_log.h"
#include "learn/imitate.h"
#include "learn/long_run.h"
#include "learn/recipe.h"
#include "play/stream.h"
#include "world/world.h"

namespace synpo {

constexpr int64_t kMostUpdates = INT64_MAX - 1;  // one more stands for a number that is not known yet

struct TrainingSettings : LongRun {
  TrainingSettings() : LongRun(1000, 100) {}

  // A resumed run has all of these but the limits from its checkpoint; `world` then is where its environments lie.
  std::string world = "gridworld", pairs, method = "synpo", init;
  RecipeOptions recipe;
  // The limit: so many updates in all, or as many as fit into a time; 0: not given, for a resumed run alone.
  int64_t updates = 0;
  double limit_s = 0;
  std::vector<std::string> stream;  // files, one after the other; none: standard input
  int64_t expect = 0;               // trajectories that it must have
  bool expect_end = false;          // it must say its end
  // Says that a limit in time has been turned into a number of updates.
  std::function<std::string(int64_t total)> told = nullptr;
  // Says that the run learns from the starts that success matrices are made of.
  std::function<std::string(const TestedStart&)> on_tested_start = nullptr;
};

// How many updates fit into `limit_s`: `done` of them, at least 1, ended after `elapsed_s`. They took the last
// `updating_s` of it; what was before is done once. At least `done`.
int64_t updates_within(double limit_s, double elapsed_s, double updating_s, int64_t done);

// A run that was stopped while its limit in time was still unknown as a number of updates goes on without a limit.
constexpr Cause kNoLimit{"no limit"};

class Training : public LongWork {
 public:
  // Opens the world and the checkpoints. Throws kUsage (also kNoLimit), kData and what opening them throws. The
  // settings must live as long.
  Training(const TrainingSettings& settings, Parallel& parallel);

  const Imitation& run() const { return *run_; }

  void begin() override;
  void update(Progress& progress) override;
  void end() override;
  int64_t updates() const override { return run_->updates(); }
  bool finished() const override;
  bool has_learned() const override { return run_->updates() > 0; }
  const char* unit() const override { return "updates"; }
  uint64_t done() const override { return uint64_t(run_->updates()); }
  uint64_t total() const override;
  const std::vector<std::string>& columns() const override { return run_log_columns(); }
  std::string report(const Report& report) override;
  void settle() override { run_->settle(); }
  Checkpoint checkpoint(bool with_training_state) override { return run_->checkpoint(with_training_state); }
  // Whether a limit in time is not a number of updates yet.
  bool timing() const { return to_time_ > 0; }

 private:
  void check_length();
  void tell_total(Progress& progress);
  void note_tested_start(Progress& progress);

  const TrainingSettings& settings_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Imitation> run_;
  std::optional<Input> input_;
  std::optional<TrajectoryStream> stream_;
  // A limit in time becomes a number of updates by the rate of the first `to_time_` ones, or of fewer where so many do
  // not fit into it; 0: there is no such limit, or the number is known.
  int64_t first_ = 0, to_time_ = 0;
  int64_t slow_ = 0;  // of those, how many say nothing about the rate
  TimePoint start_, filled_;
  bool noted_tested_start_ = false;
};

}  // namespace synpo
