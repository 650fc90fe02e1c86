// Expert trajectories, and expert labels for anyone's trajectories, as JSON Lines on stdout.
#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "base/text.h"
#include "play/episode.h"
#include "play/world_factory.h"

using namespace synpo;

namespace {

void relabel(const World& world, Output& output) {
  Input input("-");
  std::string line;
  while (input.line(line)) {
    stop_if_asked();
    try {
      output.write(format_trajectory(relabelled(world, parse_trajectory(line, kStepLimit))) + "\n");
    } catch (const Error& error) {
      input.bad_line(error);
    }
  }
}

int gen_expert(int argc, char** argv) {
  std::string world_name = "gridworld", pairs_path, output_path = "-";
  int64_t count = 0, per_pair = 0, seed = 1, window = 1;
  double noise = 0;
  bool relabel_stream = false, quiet = false;
  Options options(
      "synpo-gen-expert",
      "[-p PAIRS] [-n COUNT] [OPTION]...\n       synpo-gen-expert --relabel [-w WORLD] [-o FILE] < TRAJECTORIES",
      "Writes trajectories of the shortest-path expert, a JSON object a line.");
  options
      .text('p', "pairs", "FILE", "pairs to draw from: TSV env, task, seen; rows with seen = 1 (all pairs)", pairs_path)
      .integer('n', "count", "N", "trajectories, each of a random pair; 0: until the reader goes away", count, 0,
               INT64_MAX)
      .integer(0, "per-pair", "N", "instead of -n: N trajectories of every pair, in order; 0: no", per_pair, 0,
               INT64_MAX / 100000)
      .integer('s', "seed", "N", "seed", seed, 0, INT64_MAX)
      .real(0, "noise", "P", "probability of a random move in place of the expert's; labels stay the expert's", noise,
            0, 1)
      .flag(0, "relabel", "trajectories on stdin; out come the same with the expert's labels", relabel_stream)
      .integer(0, "window", "R", "window radius noted in the records (0: blind)", window, 0, 16)
      .text('w', "world", "WORLD", alternatives(world_names()).c_str(), world_name)
      .text('o', "output", "FILE", "write to FILE", output_path)
      .flag('q', "quiet", "no progress", quiet);
  options.parse(argc, argv);
  if (relabel_stream)
    for (const char* other : {"pairs", "count", "per-pair", "noise", "seed", "window"})
      if (options.given(other)) fail(Exit::kUsage, "--relabel does not go with --", other);
  if (per_pair > 0 && options.given("count")) fail(Exit::kUsage, "-n and --per-pair exclude each other");

  catch_stop_signals();
  const std::unique_ptr<World> opened = open_world(world_name);
  const World& world = *opened;
  Output output(output_path);
  if (relabel_stream) {
    relabel(world, output);
    output.finish();
    return 0;
  }
  std::vector<EnvTask> pairs;
  if (pairs_path.empty()) {
    for (int env = 0; env < world.envs(); ++env)
      for (int task = 0; task < world.task_count(); ++task) pairs.push_back({env, task});
  } else {
    Input input(pairs_path);
    pairs = resolve_pairs(world, read_pairs(input), true, input.name());
  }
  if (pairs.empty()) fail(Exit::kData, "no pair with seen = 1 in '", pairs_path, "'");

  const int64_t total = per_pair > 0 ? per_pair * int64_t(pairs.size()) : count;
  Progress progress("synpo-gen-expert", "trajectories", total, quiet || output.is_stdout());
  for (int64_t i = 0; total == 0 || i < total; ++i) {
    const size_t pick = per_pair > 0 ? size_t(i / per_pair)
                                     : Random(seed, Purpose::kPairOrder, 0, uint64_t(i)).below(uint32_t(pairs.size()));
    const int64_t episode = per_pair > 0 ? i % per_pair : i;
    output.write(format_trajectory(expert_episode(world, pairs[pick], seed, episode, noise, int(window))) + "\n");
    progress.update(uint64_t(i + 1));
    stop_if_asked();
  }
  output.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_tool("synpo-gen-expert", argc, argv, gen_expert, {kSeeWorld}); }
