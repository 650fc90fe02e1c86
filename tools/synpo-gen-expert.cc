// Expert trajectories, and expert labels for anyone's trajectories, as JSON Lines on stdout; and the worlds themselves,
// for other programs to play in.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/descriptor.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "base/text.h"
#include "format/trajectory.h"
#include "play/episode.h"
#include "play/serve/episode_server.h"
#include "play/world_factory.h"
#include "world/world.h"

using namespace synpo;

namespace {

// The stream says its end where `says_end`, and then the one that it comes from must have said it.
void relabel(const World& world, const std::vector<std::string>& files, Output& output, bool says_end) {
  Input input(files);
  TrajectoryLines lines(input);
  std::string line;
  while (lines.next(line)) {
    stop_if_asked();
    try {
      line = format_trajectory(relabelled(world, parse_trajectory(line, kStepLimit))) + "\n";
    } catch (const Error& error) {
      input.bad_line(error);
    }
    output.write(line);
  }
  if (!says_end) return;
  lines.check_end();
  output.write(format_end(lines.count()) + "\n");
}

int gen_expert(int argc, char** argv) {
  std::string world_name = "gridworld", pairs_path, output_path = "-";
  ExpertStream stream;
  int64_t count = 0;
  bool relabel_stream = false, play = false, says_end = false, quiet = false;
  Options options(
      "synpo-gen-expert",
      "[-p PAIRS] [-n COUNT] [OPTION]...\n       synpo-gen-expert --relabel [--end] [-w WORLD] [-o FILE] "
      "[TRAJECTORIES]...\n       synpo-gen-expert --play [-w WORLD] [-p PAIRS] [--window R] < REQUESTS > ANSWERS",
      "Writes trajectories of the shortest-path expert, a JSON object a line.");
  options
      .text('p', "pairs", "FILE", "pairs to draw from: TSV env, task, seen; rows with seen = 1 (all pairs)", pairs_path)
      .integer('n', "count", "N", "trajectories, each of a random pair; 0: until the reader goes away", count, 0,
               INT64_MAX)
      .integer(0, "per-pair", "N", "instead of -n: N trajectories of every pair, in order; 0: no", stream.per_pair, 0,
               INT64_MAX / 100000)
      .seed(stream.seed)
      .real(0, "noise", "P", "probability of a random move in place of the expert's; labels stay the expert's",
            stream.noise, 0, 1)
      .flag(0, "relabel", "instead: read trajectories, write the same with the expert's labels", relabel_stream)
      .flag(0, "play", "play what another program asks for: requests on stdin, observations on stdout", play)
      .integer(0, "window", "R", "window radius noted in the records (0: blind)", stream.window, 0, 16)
      .flag(0, "end", "a last line says how many trajectories there are (--relabel: if it did so there)", says_end)
      .text('w', "world", "WORLD", alternatives(world_names()), world_name)
      .suggest(world_kinds())
      .text('o', "output", "FILE", "write to FILE", output_path)
      .quiet(quiet);
  const std::vector<std::string> files = options.parse(argc, argv, 0, kMostStreamFiles);
  if (!relabel_stream && !files.empty()) options.wrong("unexpected operand " + quoted(files[0]));
  if (relabel_stream)
    for (const char* other : {"pairs", "count", "per-pair", "noise", "seed", "window"})
      if (options.given(other)) fail(Exit::kUsage, "--relabel does not go with --", other);
  if (play)
    for (const char* other : {"count", "per-pair", "noise", "seed", "relabel", "end", "output"})
      if (options.given(other)) fail(Exit::kUsage, "--play does not go with --", other);
  if (stream.per_pair > 0 && options.given("count")) fail(Exit::kUsage, "-n and --per-pair exclude each other");
  if (says_end && !relabel_stream && stream.per_pair == 0 && count == 0)
    fail(Exit::kUsage, "--end goes with -n or --per-pair: a stream without an end never says it");

  catch_stop_signals();
  const std::unique_ptr<World> opened = open_world(world_name);
  const World& world = *opened;
  Output output(output_path, Output::Kind::kStream);
  if (relabel_stream) {
    relabel(world, files, output, says_end);
    output.finish();
    return 0;
  }
  stream.pairs =
      pairs_path.empty() ? resolve_pairs(world, all_pairs(world), false, "") : read_seen_pairs(world, pairs_path);
  if (play) {
    Input input("-");
    EpisodeServer(world, stream.pairs, stream.window).serve(input, output);
    output.finish();
    return 0;
  }
  const int64_t total = stream.per_pair > 0 ? stream.per_pair * int64_t(stream.pairs.size()) : count;
  // In a pipe the reader shows its own.
  const bool piped = output.is_stdout() && file_of_descriptor(1).empty();
  Progress progress("synpo-gen-expert", "trajectories", total, quiet || piped);
  for (int64_t i = 0; total == 0 || i < total; ++i) {
    output.write(format_trajectory(stream.trajectory(world, i)) + "\n");
    progress.update(uint64_t(i + 1));
    stop_if_asked();
  }
  if (says_end) output.write(format_end(uint64_t(total)) + "\n");
  output.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_tool("synpo-gen-expert", argc, argv, gen_expert, {kSeeWorld, kWriteEnd}); }
