// Imitation learning: expert trajectories on stdin, a checkpoint on stdout.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/signals.h"
#include "base/text.h"
#include "learn/imitate.h"
#include "learn/long_run.h"
#include "play/world_factory.h"
#include "policy/method/registry.h"

using namespace synpo;

namespace {

constexpr int64_t kUnknown = INT64_MAX;  // total of a run whose limit in time has not been told in updates

struct Settings : LongRun {
  std::string world = "gridworld", pairs, method = "synpo", resume, init, time;
  int64_t updates = 20000, expect = 0;
  Settings() : LongRun(1000, 100) {}
};

std::string percent(double part) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * part);
  return std::isnan(part) ? "-" : text;
}

void check_length(TrajectoryStream& stream, const Settings& settings) {
  const uint64_t length = stream.length_up_to(uint64_t(settings.expect));
  if (length < uint64_t(settings.expect))
    fail(Exit::kData, "the stream ended after ", length, " trajectories, expected ", settings.expect);
}

// Updates until the total is reached or a signal comes; returns the signal, or 0.
int train(Imitation& run, TrajectoryStream& stream, RunOutputs& outputs, const Settings& settings, double limit_s) {
  const bool counted = run.total_updates() != kUnknown;
  Progress progress("synpo-train", "updates", counted ? uint64_t(run.total_updates()) : 0, settings.quiet,
                    uint64_t(run.updates()));
  const TimePoint start = now();
  TimePoint reported = start;
  const int64_t first = run.updates();
  // Timed are updates that do not depend on the total: those of the warm-up, all where nothing moves, else the first.
  const ImitationOptions& options = run.options();
  const bool moves = options.cosine || options.balance_final != 0;
  const int64_t measured = options.warm_up > 0 ? std::min<int64_t>(50, int64_t(options.warm_up)) : moves ? 1 : 50;
  std::string note;
  // With a limit in time the total is not known before some updates have been timed.
  const auto goes_on = [&] {
    return run.updates() < run.total_updates() || (limit_s > 0 && run.updates() < first + measured);
  };
  while (goes_on() && stop_signal() == 0) {
    try {
      if (!run.update(stream)) fail(Exit::kData, "standard input has no trajectory");
    } catch (const Stopped&) {
      break;
    }
    if (stream.ended()) check_length(stream, settings);
    const int64_t done = run.updates();
    if (limit_s > 0 && done - first == measured) {
      const double elapsed = seconds_since(start);
      run.set_total_updates(first + std::max(measured, int64_t(limit_s / elapsed * measured)));
      progress.set_total(uint64_t(run.total_updates()));
      if (!settings.quiet && first == 0)
        std::fprintf(stderr, "synpo-train: %s make %lld updates; -n %lld repeats this run\n", settings.time.c_str(),
                     (long long)run.total_updates(), (long long)run.total_updates());
    }
    const bool last = done == run.total_updates();
    if (settings.reports(done, last)) {
      RunLogRow row = run.take_report();
      row.seconds = seconds_since(start);
      row.states_per_s /= seconds_since(reported);
      note = short_count(row.states_per_s) + " states/s, loss " + std::to_string(row.loss).substr(0, 5) +
             ", right: move " + percent(row.right[0]) + " pick " + percent(row.right[1]) + " walk on " +
             percent(row.right[2]) + " start " + percent(row.right[3]);
      if (settings.evaluates(done, last)) {
        row.evaluation = run.evaluate_sample(int(settings.evaluate_episodes));
        if (!settings.quiet)
          std::fprintf(stderr, "synpo-train: update %lld: success %s seen, %s unseen\n", (long long)done,
                       percent(row.evaluation->seen_success).c_str(), percent(row.evaluation->unseen_success).c_str());
      }
      outputs.log().write(run_log_values(row));
      reported = now();
    }
    if (settings.saves(done, last)) outputs.save(run.checkpoint(true));
    progress.update(uint64_t(done), note);
  }
  return stop_signal();
}

int body(int argc, char** argv) {
  Settings s;
  RecipeOptions hyper;
  const std::string methods = alternatives(method_names());
  Options options("synpo-train", "[-n UPDATES | --time LIMIT] [OPTION]... < TRAJECTORIES > CHECKPOINT",
                  "Learns a policy from expert trajectories. When the stream ends it goes on with those it keeps.");
  options.integer('n', "count", "N", "updates in all; a resumed run has the checkpoint's", s.updates, 1, kUnknown - 1)
      .text(0, "time", "LIMIT", "instead of -n: as many updates as fit (90s, 30m, 2h), told from the first ones",
            s.time)
      .text('p', "pairs", "FILE", "the seen pairs: TSV env, task, seen (the pairs that the stream brings first)",
            s.pairs)
      .choice('m', "method", "NAME", methods.c_str(), s.method, method_names())
      .text('w', "world", "WORLD", alternatives(world_names()).c_str(), s.world)
      .text(0, "resume", "FILE", "go on from a checkpoint, on the same stream, to the same bits", s.resume)
      .text(0, "init", "FILE", "start from a checkpoint's weights, all else fresh", s.init)
      .integer(0, "expect", "N", "a stream of fewer than N trajectories is an error", s.expect, 0, INT64_MAX);
  s.add_to(options);
  hyper.add_to(options);
  options.parse(argc, argv);
  double limit_s = 0;
  if (!s.time.empty()) try {
      limit_s = parse_seconds(s.time);
    } catch (const std::invalid_argument& error) {
      fail(Exit::kUsage, "option --time: found ", quoted(s.time), ", ", error.what());
    }
  const bool resumes = !s.resume.empty();
  if (resumes &&
      (hyper.given() || !s.init.empty() || options.given("pairs") || options.given("method") || options.given("seed")))
    fail(Exit::kUsage, "--resume takes everything but the limit from the checkpoint");
  if (limit_s > 0 && options.given("count")) fail(Exit::kUsage, "-n and --time exclude each other");
  catch_stop_signals();

  Parallel parallel(int(s.threads));
  const Checkpoint from = resumes ? load_checkpoint(s.resume) : Checkpoint();
  const std::unique_ptr<World> opened =
      resumes ? world_of(from, options.given("world") ? s.world : "") : open_world(s.world);
  const World& world = *opened;
  std::vector<EnvTask> seen;
  if (!s.pairs.empty()) {
    Input input(s.pairs);
    seen = resolve_pairs(world, read_pairs(input), true, input.name());
    if (seen.empty()) fail(Exit::kData, "no pair with seen = 1 in '", s.pairs, "'");
  }
  std::unique_ptr<Imitation> run;
  if (resumes) {
    run = std::make_unique<Imitation>(world, parallel, from);
  } else {
    run = std::make_unique<Imitation>(world, parallel, s.method, hyper.result(s.method, world.observation_spec().sight),
                                      seen, uint64_t(s.seed));
    if (!s.init.empty()) {
      Checkpoint init = load_checkpoint(s.init);
      init.seen.clear();  // of its own world
      run->take_weights(load_model(init, world));
    }
  }
  if (options.given("count") || (!resumes && limit_s == 0)) run->set_total_updates(s.updates);
  if (!resumes && limit_s > 0) run->set_total_updates(kUnknown);
  if (resumes && limit_s == 0 && run->total_updates() == kUnknown)
    fail(Exit::kUsage, "the run was stopped before its --time was told in updates: give -n or --time");

  // Made before the training, so that hours of it don't end in "cannot create".
  RunOutputs outputs(s, s.resume, run_log_columns());
  int signal = 0;
  if (run->updates() < run->total_updates() || limit_s > 0) {
    Input input("-");
    TrajectoryStream stream(input, world, run->allowed(), run->window());
    stream.skip(run->stream_lines(), run->stream_hash());
    signal = train(*run, stream, outputs, s, limit_s);
    if (run->updates() == 0) stop_if_asked();
    if (!s.save.empty()) outputs.save(run->checkpoint(true));
    if (signal == 0) check_length(stream, s);
  }
  const bool unfinished = run->updates() < run->total_updates();
  outputs.finish(run->checkpoint(!s.strip));
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  if (!s.quiet)
    std::fprintf(stderr, "synpo-train: %s%lld updates, %s states, peak memory %.0f MB\n", unfinished ? "stopped: " : "",
                 (long long)run->updates(), short_count(double(run->model().states)).c_str(), usage.ru_maxrss / 1024.0);
  return unfinished && signal ? 128 + signal : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_tool("synpo-train", argc, argv, body,
                  {kSeeWorld,
                   kNameFolder,
                   kNameOtherFolder,
                   kLeaveWorld,
                   kSmallerRate,
                   {kNoTrainingState, "{}: --init takes its weights"}});
}
