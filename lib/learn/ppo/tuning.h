// Fine-tuning by PPO from its settings to its end: where it begins, how long it lasts, its reports.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/parallel.h"
#include "format/checkpoint.h"
#include "learn/long_run.h"
#include "learn/ppo/ppo.h"
#include "learn/ppo/ppo_options.h"
#include "world/world.h"

namespace synpo {

// Neither the checkpoint nor a file of pairs says what to learn on.
constexpr Cause kNoPairs{"no pairs"};

struct TuningSettings : LongRun {
  TuningSettings() : LongRun(100, 10) {}

  std::string checkpoint = "-";  // the policy to begin with
  bool random = false;           // weights drawn at random instead, of `method`
  std::string method = "synpo";
  std::string world;  // the one to learn in, where `random`; else where the checkpoint's environments lie
  std::string pairs;
  int64_t steps = 20000000;
  PpoOptions ppo;
};

class Tuning : public LongWork {
 public:
  // Opens the world and the checkpoint; `given` knows which losses' weights were named. Throws kData (kNoPairs) where
  // there is no pair to learn on, and what opening them throws.
  Tuning(const TuningSettings& settings, const Options& given, Parallel& parallel);

  void update(Progress&) override { run_->update(); }
  int64_t updates() const override { return run_->updates(); }
  bool finished() const override { return run_->steps() >= steps_; }
  const char* unit() const override { return "steps"; }
  uint64_t done() const override { return uint64_t(run_->steps()); }
  uint64_t total() const override { return uint64_t(steps_); }
  const std::vector<std::string>& columns() const override;
  std::string report(const Report& report) override;
  Checkpoint checkpoint(bool with_training_state) override { return run_->checkpoint(with_training_state); }

 private:
  Parallel& parallel_;
  int64_t steps_;
  std::unique_ptr<World> world_;
  std::optional<Ppo> run_;
  int64_t reported_steps_;
};

}  // namespace synpo
