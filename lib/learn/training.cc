#include "learn/training.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/text.h"
#include "play/episode.h"
#include "play/model.h"
#include "play/world_factory.h"

namespace synpo {
namespace {

constexpr int64_t kUnknown = kMostUpdates + 1;  // total of a run whose limit in time has not been told in updates

// Updates that do not depend on the total: those of the warm-up, all where nothing moves, else the first.
int64_t updates_to_time(const ImitationOptions& options) {
  const bool moves = options.cosine || options.balance_final != 0;
  return options.warm_up > 0 ? std::min<int64_t>(50, int64_t(options.warm_up)) : moves ? 1 : 50;
}

std::unique_ptr<Imitation> fresh_run(const TrainingSettings& s, const World& world, Parallel& parallel) {
  std::vector<EnvTask> seen;
  if (!s.pairs.empty()) seen = read_seen_pairs(world, s.pairs);
  auto run = std::make_unique<Imitation>(
      world, parallel, s.method, s.recipe.result(s.method, world.observation_spec().sight), std::move(seen), s.seed);
  if (!s.init.empty()) {
    Checkpoint init = load_checkpoint(s.init);
    init.seen.clear();  // of its own world
    run->take_weights(load_model(init, world));
  }
  run->set_total_updates(s.updates > 0 ? s.updates : kUnknown);
  return run;
}

}  // namespace

// The first updates on a GPU load its libraries and record what is replayed later: they say nothing about the others.
constexpr int64_t kSlowOnDevices = 5;

int64_t updates_within(double limit_s, double elapsed_s, double updating_s, int64_t done) {
  const double more = std::max(0.0, limit_s - elapsed_s) / std::max(updating_s, 1e-9) * double(done);
  return done + int64_t(std::min(more, 1e18));
}

Training::Training(const TrainingSettings& settings, Parallel& parallel) : settings_(settings) {
  if (settings.resume.empty()) {
    world_ = open_world(settings.world);
    run_ = fresh_run(settings, *world_, parallel);
  } else {
    const Checkpoint from = load_checkpoint(settings.resume);
    world_ = world_of(from, settings.world);
    run_ = std::make_unique<Imitation>(*world_, parallel, from);
    if (settings.updates > 0 && settings.updates < run_->updates())
      fail(Exit::kUsage, "found ", settings.updates, " updates in all, expected at least the ", run_->updates(),
           " that the checkpoint has");
    if (settings.updates > 0) run_->set_total_updates(settings.updates);
    if (settings.limit_s == 0 && run_->total_updates() == kUnknown)
      fail(Exit::kUsage, kNoLimit, "the run was stopped before its limit in time was told in updates");
  }
  run_->compute_on(settings.device);
  first_ = run_->updates();
  to_time_ = settings.limit_s > 0 ? updates_to_time(run_->options()) : 0;
  if (!settings.device.is_cpu()) slow_ = std::clamp<int64_t>(to_time_ - 1, 0, kSlowOnDevices);
}

bool Training::finished() const { return !timing() && run_->updates() >= run_->total_updates(); }

uint64_t Training::total() const { return run_->total_updates() == kUnknown ? 0 : uint64_t(run_->total_updates()); }

void Training::check_length() {
  const uint64_t expected = uint64_t(settings_.expect), length = stream_->length_up_to(expected);
  if (length < expected)
    fail(Exit::kData, "the stream ended after ", length, " trajectories, expected ", settings_.expect);
  if (settings_.expect_end) stream_->check_end();
}

void Training::begin() {
  input_.emplace(settings_.stream);
  stream_.emplace(*input_, *world_, run_->allowed(), run_->window());
  stream_->skip(run_->stream_lines(), run_->stream_hash());
  start_ = now();
}

void Training::update(Progress& progress) {
  run_->read(*stream_);
  if (run_->updates() <= first_ + slow_) filled_ = now();
  if (!run_->learn()) fail(Exit::kData, input_->whole_name(), " has no trajectory");
  note_tested_start(progress);
  if (stream_->ended()) check_length();
  if (timing()) tell_total(progress);
}

void Training::tell_total(Progress& progress) {
  run_->settle();
  const int64_t done = run_->updates() - first_;
  const double elapsed_s = seconds_since(start_);
  if (done <= slow_) return;
  const int64_t fit = slow_ + updates_within(settings_.limit_s, elapsed_s, seconds_since(filled_), done - slow_);
  const bool too_slow = fit < to_time_ && elapsed_s >= settings_.limit_s / 2;
  if (done < to_time_ && !too_slow) return;
  run_->set_total_updates(first_ + std::min(fit, kMostUpdates - first_));
  to_time_ = 0;
  if (first_ == 0 && settings_.told) progress.say(settings_.told(run_->total_updates()));
}

void Training::note_tested_start(Progress& progress) {
  const bool learns_states = run_->options().batch_states == 0 || !run_->options().fresh_starts;
  if (noted_tested_start_ || !learns_states || !stream_->tested_start() || !settings_.on_tested_start) return;
  progress.warn(settings_.on_tested_start(*stream_->tested_start()));
  noted_tested_start_ = true;
}

void Training::end() {
  // A run that was done when it was resumed has read nothing, and needs no stream but to hear of its end.
  if (!stream_ && (settings_.expect > 0 || settings_.expect_end)) begin();
  if (stream_) check_length();
}

std::string Training::report(const Report& report) {
  RunLogRow row = run_->take_report();
  row.seconds = report.seconds;
  row.states_per_s /= report.interval_s;
  if (report.evaluate_episodes > 0) {
    row.evaluation = run_->evaluate_sample(report.evaluate_episodes);
    report.progress.say(concat("update ", row.update, ": success ", percent_text(row.evaluation->seen_success),
                               " seen, ", percent_text(row.evaluation->unseen_success), " unseen"));
  }
  report.log.write(run_log_values(row));
  return concat("loss ", std::to_string(row.loss).substr(0, 5), ", ", short_count(row.states_per_s),
                " states/s, right: move ", percent_text(row.right[0]), ", pick ", percent_text(row.right[1]),
                ", walk on ", percent_text(row.right[2]), ", start ", percent_text(row.right[3]));
}

}  // namespace synpo
