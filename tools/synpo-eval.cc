// A checkpoint in, its success matrix out.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/files/side_output.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "format/checkpoint.h"
#include "format/matrix.h"
#include "format/pairs.h"
#include "format/trajectory.h"
#include "play/episode.h"
#include "play/evaluate.h"
#include "play/model.h"
#include "play/world_factory.h"
#include "policy/policy.h"
#include "world/world.h"

using namespace synpo;

namespace {

void note_new_pairs(const Matrix& matrix) {
  const auto is_new = [](const MatrixRow& row) { return row.is_new; };
  const auto count = std::count_if(matrix.rows.begin(), matrix.rows.end(), is_new);
  if (count > 0)
    std::fprintf(stderr,
                 "synpo-eval: note: %lld of %zu pairs are new, not unseen: training met the environment or the task in "
                 "no pair\n",
                 (long long)count, matrix.rows.size());
}

// Where the matrix and the record of its episodes go. A record that cannot be written does not cost the matrix.
class Results {
 public:
  // No matrix where the record takes its place on stdout, or where none is wanted.
  // `says_end`: the record's last line says how many episodes it has.
  Results(const std::string& output_path, bool output_given, const std::string& record_path, bool says_end,
          bool wants_matrix)
      : says_end_(says_end) {
    const bool records_to_stdout = record_path == "-";
    if (records_to_stdout && output_path == "-" && output_given)
      fail(Exit::kUsage, "matrix and trajectories cannot both go to stdout");
    if (!record_path.empty()) record_.emplace(record_path);
    if (wants_matrix && (!records_to_stdout || output_path != "-")) output_.emplace(output_path);
  }
  EpisodeSink sink() {
    if (!record_) return nullptr;
    return [this](const Trajectory& trajectory) {
      record_->write(format_trajectory(trajectory) + "\n");
      ++recorded_;
      if (!output_) record_->check();
    };
  }
  bool have_matrix() const { return output_.has_value(); }
  void finish(const Matrix& matrix) {
    if (record_ && says_end_) record_->write(format_end(recorded_) + "\n");
    if (record_) record_->finish();
    if (output_) {
      write_matrix(*output_, matrix);
      output_->finish();
    }
    if (record_) record_->check();
  }

 private:
  bool says_end_;
  uint64_t recorded_ = 0;
  std::optional<SideOutput> record_;
  std::optional<Output> output_;
};

int body(int argc, char** argv) {
  std::string checkpoint_path = "-", pairs_path, world_name, output_path = "-", record_path, starts = "evaluation";
  MatrixPlan plan;
  plan.temperature = kTemperature;  // unless the method has another
  int threads = 0;
  DeviceOptions device;
  bool says_end = false, describe = false, quiet = false;
  Options options("synpo-eval", "[-p PAIRS] [-n EPISODES] [OPTION]... [CHECKPOINT] > MATRIX",
                  "Runs the policy of a checkpoint on every pair and counts successes.");
  options.text('c', "checkpoint", "FILE", "the checkpoint", checkpoint_path)
      .text('p', "pairs", "FILE", "pairs to run, all its rows: TSV env, task (all pairs)", pairs_path)
      .text('w', "world", "WORLD", "needed as kitchen:DIR, where the checkpoint's kitchens lie in files of their own",
            world_name)
      .suggest(world_kinds())
      .integer('n', "count", "N", "episodes of every pair", plan.count, 1, 100000000)
      .integer(0, "first-episode", "N", "number of the first of them: shards of one evaluation merge", plan.first, 0,
               1000000000000)
      .seed(plan.seed, "seed of the start states, which are the same for every checkpoint")
      .real(0, "temperature", "T", "actions are drawn from the policy, its scores divided by T; 0: always the best one",
            plan.temperature, 0, 1000)
      .threads(threads);
  device.add_to(options);
  options
      .text(0, "record", "FILE",
            "write the episodes to FILE as trajectories with the expert's labels; - is stdout, in place of the matrix",
            record_path)
      .flag(0, "end", "the record's last line says how many episodes it has", says_end)
      .flag(0, "scores", "the trajectories have the policy's scores and probabilities at every step", plan.scores)
      .choice(0, "starts", "USE", "start states: evaluation, or training for records to learn from, without a matrix",
              starts, {"evaluation", "training"})
      .text('o', "output", "FILE", "write the matrix to FILE", output_path)
      .flag(0, "describe", "print what the checkpoint says of itself, as JSON, and quit", describe)
      .quiet(quiet);
  checkpoint_path = one_file(options, "checkpoint", checkpoint_path, options.parse(argc, argv, 0, 1));
  if (describe) options.alone("describe", {"checkpoint", "output", "quiet"});
  const bool for_training = starts == "training";
  if (for_training && record_path.empty()) fail(Exit::kUsage, "--starts training goes with --record");
  if (says_end && record_path.empty()) fail(Exit::kUsage, "--end goes with --record");
  if (plan.scores && record_path.empty()) fail(Exit::kUsage, "--scores goes with --record");
  if (for_training && options.given("output"))
    fail(Exit::kUsage, "--starts training writes no matrix: -o does not go with it");

  const Checkpoint checkpoint = load_checkpoint(checkpoint_path);
  if (describe) {
    write_file(output_path, checkpoint.describe() + "\n", Output::Kind::kText);
    return 0;
  }
  const std::unique_ptr<World> world = world_of(checkpoint, world_name);
  Model model = load_model(checkpoint, *world);
  if (!options.given("temperature")) plan.temperature = model.policy->temperature();
  if (for_training) plan.use = kForTraining;
  plan.pairs_file = pairs_path;
  plan.pairs = pairs_path.empty() ? all_pairs(*world) : read_pairs(pairs_path);

  Results results(output_path, options.given("output"), record_path, says_end, !for_training);
  catch_stop_signals();
  Parallel parallel(threads);
  compute_on(device, parallel, model);
  Progress progress("synpo-eval", "episodes", plan.pairs.size() * size_t(plan.count), quiet);
  const std::string run = hex(checkpoint.weights_hash());
  const Matrix matrix = success_matrix(parallel, *world, model, run, plan, results.sink(), [&](size_t done) {
    progress.update(done);
    stop_if_asked();
  });
  progress.finish();
  results.finish(matrix);
  if (results.have_matrix() && !quiet) note_new_pairs(matrix);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_tool("synpo-eval", argc, argv, body, {kNameFolder, kNameOtherFolder, kLeaveWorld, kBuildPlugin});
}
