// A checkpoint on stdin, its success matrix on stdout.
#include <cstdio>
#include <memory>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/side_output.h"
#include "base/hash.h"
#include "base/signals.h"
#include "format/matrix.h"
#include "play/evaluate.h"
#include "play/model.h"

using namespace synpo;

namespace {

int body(int argc, char** argv) {
  std::string checkpoint_path = "-", pairs_path, world_name, output_path = "-", record_path;
  int64_t count = 100, first = 0, seed = 1, threads = 0;
  double temperature = kTemperature;  // unless the method has another
  bool describe = false, quiet = false;
  Options options("synpo-eval", "[-p PAIRS] [-n EPISODES] [OPTION]... < CHECKPOINT > MATRIX",
                  "Runs the policy of a checkpoint on every pair and counts successes.");
  options.text('c', "checkpoint", "FILE", "the checkpoint", checkpoint_path)
      .text('p', "pairs", "FILE", "pairs to run, all its rows: TSV env, task (all pairs)", pairs_path)
      .text('w', "world", "WORLD", "kitchen:DIR, where the checkpoint's kitchens lie in files of their own", world_name)
      .integer('n', "count", "N", "episodes of every pair", count, 1, 100000000)
      .integer(0, "first-episode", "N", "number of the first of them: shards of one evaluation merge", first, 0,
               1000000000000)
      .integer('s', "seed", "N", "seed of the start states, which are the same for every checkpoint", seed, 0,
               INT64_MAX)
      .real(0, "temperature", "T", "actions are drawn from the policy, its scores divided by T; 0: always the best one",
            temperature, 0, 1000)
      .integer('j', "threads", "N", "threads; 0: as many as there are; results don't depend on it", threads, 0, 1024)
      .text(0, "record", "FILE",
            "write the episodes to FILE as trajectories with the expert's labels; - is stdout, in place of the matrix",
            record_path)
      .text('o', "output", "FILE", "write the matrix to FILE", output_path)
      .flag(0, "describe", "print what the checkpoint says of itself, as JSON, and quit", describe)
      .flag('q', "quiet", "no progress", quiet);
  options.parse(argc, argv);

  const Checkpoint checkpoint = load_checkpoint(checkpoint_path);
  if (describe) {
    write_file(output_path, checkpoint.describe() + "\n", Output::Kind::kText);
    return 0;
  }
  const std::unique_ptr<World> restored = world_of(checkpoint, world_name);
  const World& world = *restored;
  Model model = load_model(checkpoint, world);
  if (!options.given("temperature")) temperature = model.policy->temperature();
  std::vector<PairRow> rows;
  const bool listed = !pairs_path.empty();
  if (listed) {
    Input pairs_input(pairs_path);
    rows = read_pairs(pairs_input);
  } else {
    for (const Environment& env : world.environments())
      for (const std::string& task : world.task_names()) rows.push_back({env.name, task, false, ""});
  }
  const std::vector<EnvTask> pairs =
      resolve_pairs(world, rows, false, pairs_path.empty() ? checkpoint.source : pairs_path);
  if (pairs.empty()) fail(Exit::kData, "no pair in '", pairs_path, "'");

  const bool records_to_stdout = record_path == "-";
  if (records_to_stdout && output_path == "-" && options.given("output"))
    fail(Exit::kUsage, "matrix and trajectories cannot both go to stdout");
  std::unique_ptr<SideOutput> record;
  std::unique_ptr<Output> output;
  if (!record_path.empty()) record = std::make_unique<SideOutput>(record_path);
  if (!records_to_stdout || output_path != "-") output = std::make_unique<Output>(output_path);

  catch_stop_signals();
  Parallel parallel{int(threads)};
  std::vector<std::pair<int, int>> numbers;
  std::vector<EvalEpisode> episodes;
  for (size_t p = 0; p < pairs.size(); ++p) {
    numbers.emplace_back(pairs[p].env, pairs[p].task);
    for (int64_t e = 0; e < count; ++e) episodes.push_back({int(p), first + e});
  }
  model.policy->prepare_inference(parallel, model.parameters.data(), model.statistics.data(), numbers);
  Progress progress("synpo-eval", "episodes", episodes.size(), quiet);
  EpisodeSink sink;
  if (record)
    sink = [&](const Trajectory& trajectory) {
      record->write(format_trajectory(trajectory) + "\n");
      if (!output) record->check();
    };
  const std::vector<Outcomes> results = evaluate(parallel, *model.policy, world, pairs, episodes,
                                                 {uint64_t(seed), model.window, temperature}, sink, [&](size_t done) {
                                                   progress.update(done);
                                                   stop_if_asked();
                                                 });
  progress.finish();
  if (record) record->finish();
  if (!output) {
    record->check();
    return 0;
  }

  Matrix matrix;
  const std::string run = hex(checkpoint.weights_hash());
  int64_t new_pairs = 0;
  for (size_t p = 0; p < pairs.size(); ++p) {
    const Outcomes& r = results[p];
    matrix.has_part |= !rows[p].part.empty();
    MatrixRow row;
    row.run = run;
    row.world = checkpoint.world;
    row.window = model.window;
    row.method = model.method;
    row.seed = model.seed;
    row.updates = model.updates;
    row.eval_seed = uint64_t(seed);
    row.first_episode = first;
    row.env = rows[p].env;
    row.task = rows[p].task;
    row.seen = model.is_seen(pairs[p]);
    row.episodes = r.episodes;
    row.successes = r.successes;
    row.wrong = r.wrong;
    row.timeouts = r.timeouts;
    row.reward = double(r.reward_cents) / 100;
    row.length = r.length;
    row.part = rows[p].part;
    row.temperature = temperature;
    row.is_new = !model.knows(pairs[p]);
    row.env_hash = hex(world.environments()[pairs[p].env].hash);
    new_pairs += row.is_new;
    matrix.rows.push_back(row);
  }
  write_matrix(*output, matrix);
  output->finish();
  if (record) record->check();
  if (new_pairs > 0 && !quiet)
    std::fprintf(
        stderr,
        "synpo-eval: note: %lld of %zu pairs are new, not unseen: training met the environment or the task in no "
        "pair\n",
        (long long)new_pairs, pairs.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_tool("synpo-eval", argc, argv, body, {kNameFolder, kNameOtherFolder, kLeaveWorld});
}
