// Imitation learning: expert trajectories in, a checkpoint out.
#include <sys/resource.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "base/text.h"
#include "going_on.h"
#include "learn/imitate.h"
#include "learn/recipe.h"
#include "learn/training.h"
#include "play/world_factory.h"
#include "policy/method/registry.h"

using namespace synpo;

namespace {

void summarise(const Training& training) {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::fprintf(stderr, "synpo-train: %s%s, %s states, peak memory %.0f MB\n",
               training.finished() ? "" : "stopped: ", counted(training.updates(), "update").c_str(),
               short_count(double(training.run().model().states)).c_str(), usage.ru_maxrss / 1024.0);
}

int body(int argc, char** argv) {
  TrainingSettings s;
  std::string limit;
  s.updates = 20000;
  const std::string methods = alternatives(method_names());
  Options options("synpo-train", "[-n UPDATES | --time LIMIT] [OPTION]... [TRAJECTORIES]... > CHECKPOINT",
                  "Learns a policy from expert trajectories. When the stream ends it goes on with those it keeps.");
  options.integer('n', "count", "N", "updates in all; a resumed run has the checkpoint's", s.updates, 1, kMostUpdates)
      .call(0, "time", "LIMIT", "instead of -n: as many updates as fit (90s, 30m, 2h) at the rate of the first ones",
            [&](const std::string& text) { s.limit_s = parse_seconds(limit = text); })
      .text('p', "pairs", "FILE", "the seen pairs: TSV env, task, seen (the pairs that the stream brings first)",
            s.pairs)
      .choice('m', "method", "NAME", methods, s.method, method_names())
      .text('w', "world", "WORLD", alternatives(world_names()), s.world)
      .suggest(world_kinds())
      .text(0, "resume", "FILE", "go on from a checkpoint, on the same stream, to the same bits", s.resume)
      .text(0, "init", "FILE", "start from a checkpoint's weights, all else fresh", s.init)
      .integer(0, "expect", "N", "a stream of fewer than N trajectories is an error", s.expect, 0, INT64_MAX)
      .flag(0, "expect-end", "a stream that does not say its end in a last line is an error", s.expect_end);
  s.add_to(options);
  s.recipe.add_to(options);
  s.stream = options.parse(argc, argv, 0, kMostStreamFiles);
  const bool resumes = options.given("resume"), counted = options.given("count"), timed = options.given("time");
  if (resumes && (s.recipe.given() || options.given("init") || options.given("pairs") || options.given("method") ||
                  options.given("seed")))
    fail(Exit::kUsage, "--resume takes everything but the limit from the checkpoint");
  if (timed && counted) fail(Exit::kUsage, "-n and --time exclude each other");
  if (timed || (resumes && !counted)) s.updates = 0;
  if (resumes && !options.given("world")) s.world.clear();
  s.told = [&](int64_t total) { return concat(limit, " make ", total, " updates; -n ", total, " repeats this run"); };
  s.on_tested_start = words;

  catch_stop_signals();
  Parallel parallel(s.threads);
  Training training(s, parallel);
  const int code = s.drive("synpo-train", training);
  if (!s.quiet) summarise(training);
  if (code != 0) {
    std::vector<std::string> kept = RecipeOptions::option_names();  // by the checkpoint
    kept.insert(kept.end(), {"init", "pairs", "method", "seed"});
    if (!training.timing()) kept.emplace_back("time");
    tell_how_to_go_on("synpo-train", s, options, std::move(kept), {true, s.stream});
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  return run_tool("synpo-train", argc, argv, body,
                  {kSeeWorld,
                   kWriteEnd,
                   kNameFolder,
                   kNameOtherFolder,
                   kLeaveWorld,
                   kSmallerRate,
                   kBuildPlugin,
                   {kNoTrainingState, "{}: --init takes its weights"},
                   {kNoLimit, "{}: give -n or --time"}});
}
