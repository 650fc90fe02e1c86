// A checkpoint on stdin, fine-tuned by PPO, a checkpoint on stdout.
#include <cmath>
#include <cstdio>
#include <memory>

#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/signals.h"
#include "base/text.h"
#include "finetune/finetune.h"
#include "format/run_log.h"
#include "learn/long_run.h"
#include "learn/ppo.h"
#include "learn/recipe.h"
#include "play/evaluate.h"
#include "play/world_factory.h"

using namespace synpo;

namespace {

struct Settings : LongRun {
  std::string checkpoint = "-", pairs, resume, init, world = "gridworld", method = "synpo";
  int64_t steps = 20000000, lanes, rollout, epochs, minibatches, value_warm_up;
  Settings() : LongRun(100, 10) {}
};

const std::vector<std::string> kColumns = {"update",       "states",      "seconds",
                                           "states_per_s", "episodes",    "success",
                                           "wrong",        "reward",      "length",
                                           "policy",       "value",       "entropy",
                                           "kl",           "clip",        "explained_variance",
                                           "seen_success", "seen_reward", "unseen_success",
                                           "unseen_reward"};

// Updates until there are enough steps or a signal comes; returns the signal, or 0.
int train(Ppo& run, Parallel& parallel, const World& world, RunOutputs& outputs, const Settings& s) {
  Progress progress("synpo-finetune", "steps", uint64_t(s.steps), s.quiet, uint64_t(run.steps()));
  const TimePoint start = now();
  TimePoint reported = start;
  int64_t reported_steps = run.steps();
  std::string note;
  while (run.steps() < s.steps && stop_signal() == 0) {
    run.update();
    const int64_t updates = run.updates();
    const bool last = run.steps() >= s.steps;
    if (s.reports(updates, last)) {
      const PpoReport r = run.take_report();
      const double n = double(r.finished.episodes);  // 0 / 0: nothing ended
      const double rate = double(run.steps() - reported_steps) / seconds_since(reported);
      RunLogRow::Evaluation e{NAN, NAN, NAN, NAN};
      const Model& model = run.model();
      if (s.evaluates(updates, last))
        e = evaluate_sample(parallel, world, model, model.parameters.data(), model.statistics.data(),
                            int(s.evaluate_episodes));
      outputs.log().write({double(updates), double(run.steps()), seconds_since(start), rate, n,
                           r.finished.successes / n, r.finished.wrong / n, r.finished.reward_cents / 100.0 / n,
                           r.finished.length / n, r.policy, r.value, r.entropy, r.kl, r.clip_fraction,
                           r.explained_variance, e.seen_success, e.seen_reward, e.unseen_success, e.unseen_reward});
      note = short_count(rate) + " steps/s";
      if (n > 0) note += concat(", success ", std::lround(100 * r.finished.successes / n), " %");
      reported = now();
      reported_steps = run.steps();
    }
    if (s.saves(updates, last)) outputs.save(run.checkpoint(true));
    progress.update(uint64_t(run.steps()), note);
  }
  return stop_signal();
}

void add_options(Options& options, Settings& s, PpoOptions& ppo) {
  s.lanes = ppo.lanes;
  s.rollout = ppo.rollout;
  s.epochs = ppo.epochs;
  s.minibatches = ppo.minibatches;
  s.value_warm_up = ppo.value_warm_up;
  options.text('c', "checkpoint", "FILE", "the trained policy", s.checkpoint)
      .integer(0, "steps", "N", "steps of all worlds together, such as 2e7", s.steps, 1, INT64_MAX)
      .text('p', "pairs", "FILE", "the pairs to learn on: TSV env, task, seen (the seen ones of the checkpoint)",
            s.pairs)
      .text(0, "resume", "FILE",
            "go on from a checkpoint of --save, to the same bits; the other options must be the same", s.resume)
      .text(0, "init", "random", "from scratch: a network of random weights, for -w and -m", s.init)
      .text(
          'w', "world", "WORLD",
          concat("with --init: ", alternatives(world_names()), "; else the folder of the checkpoint's scenes").c_str(),
          s.world)
      .text('m', "method", "NAME", "with --init: the method", s.method);
  s.add_to(options);
  options.section("PPO")
      .integer(0, "lanes", "N", "worlds side by side", s.lanes, 1, 4096)
      .integer(0, "rollout", "N", "steps of each before an update", s.rollout, 1, 100000)
      .integer(0, "epochs", "N", "passes over a rollout", s.epochs, 1, 1000)
      .integer(0, "minibatches", "N", "of a pass", s.minibatches, 1, 100000)
      .integer(0, "value-warm-up", "N", "first rollouts, from which the value alone learns", s.value_warm_up, 0,
               INT32_MAX)
      .real(0, "clip", "X", "how far the ratio may go from 1", ppo.clipping.clip, 0, 1)
      .real(0, "entropy", "X", "weight of the entropy", ppo.clipping.entropy, 0, 100)
      .real(0, "gradient-norm", "X", "length to which gradients are clipped", ppo.gradient_norm, 0, 1e9)
      .real(0, "discount", "X", "gamma", ppo.gae.discount, 0, 1)
      .real(0, "lambda", "X", "lambda of generalised advantage estimation", ppo.gae.lambda, 0, 1)
      .real(0, "lr", "X", "learning rate of RMSProp", ppo.optimiser.learning_rate, 0, 1)
      .real(0, "smoothing", "X", "decay of its mean square", ppo.optimiser.smoothing, 0, 1)
      .real(0, "epsilon", "X", "RMSProp's epsilon", ppo.optimiser.epsilon, 0, 1)
      .real(0, "weight-decay", "X", "L2 term added to the gradient", ppo.optimiser.weight_decay, 0, 1)
      .real(0, "value-loss", "X", "weight of the value's loss", ppo.value_loss, 0, 1e6)
      .real(0, "reward-loss", "X", "weight of reward prediction; the checkpoint's, or with --init", ppo.losses.reward,
            0, 1e6)
      .real(0, "env-loss", "X", "weight of environment disentanglement; the checkpoint's, or with --init",
            ppo.losses.env, 0, 1e6)
      .real(0, "task-loss", "X", "weight of task disentanglement; the checkpoint's, or with --init", ppo.losses.task, 0,
            1e6);
}

}  // namespace

int ppo(int argc, char** argv) {
  Settings s;
  PpoOptions tuning;
  Options options("synpo-finetune ppo", "[--steps N] [OPTION]... < CHECKPOINT > CHECKPOINT",
                  "Fine-tunes a policy by its reward.");
  add_options(options, s, tuning);
  options.parse(argc, argv);
  tuning.lanes = int(s.lanes);
  tuning.rollout = int(s.rollout);
  tuning.epochs = int(s.epochs);
  tuning.minibatches = int(s.minibatches);
  tuning.value_warm_up = int(s.value_warm_up);
  const bool random = !s.init.empty(), resumes = !s.resume.empty();
  if (random && s.init != "random") fail(Exit::kUsage, "option --init: found ", quoted(s.init), ", expected random");
  if (random && options.given("checkpoint")) fail(Exit::kUsage, "-c and --init exclude each other");
  if (!random && options.given("method")) fail(Exit::kUsage, "-m goes with --init");

  catch_stop_signals();
  Parallel parallel{int(s.threads)};
  const Checkpoint from = resumes ? load_checkpoint(s.resume) : random ? Checkpoint() : load_checkpoint(s.checkpoint);
  const LossWeights weights = auxiliary_losses(from, tuning.losses);
  if (!options.given("reward-loss")) tuning.losses.reward = weights.reward;
  if (!options.given("env-loss")) tuning.losses.env = weights.env;
  if (!options.given("task-loss")) tuning.losses.task = weights.task;
  const bool fresh = random && !resumes;
  // With --init the checkpoint of --resume may hold its world, whatever -w says.
  const bool needs_world = options.given("world") && (!random || lies_in_files(from));
  const std::unique_ptr<World> opened = fresh ? open_world(s.world) : world_of(from, needs_world ? s.world : "");
  const World& world = *opened;
  const ImitationOptions network = recipe(kDefaultRecipe, s.method, world.observation_spec().sight);
  Model model = fresh ? fresh_model(s.method, network.shape(world), {uint64_t(s.seed), network.embedding_sd})
                      : load_model(from, world);
  if (!s.pairs.empty()) {
    Input input(s.pairs);
    model.seen = resolve_pairs(world, read_pairs(input), true, input.name());
  }
  if (model.seen.empty()) fail(Exit::kData, "no pair to learn on: give them with -p");
  Ppo run(world, parallel, std::move(model), tuning, uint64_t(s.seed));
  if (resumes)
    run.resume(from);
  else if (random)
    run.measure_statistics(40);

  RunOutputs outputs(s, s.resume, kColumns);
  const int signal = train(run, parallel, world, outputs, s);
  if (!s.save.empty()) outputs.save(run.checkpoint(true));
  outputs.finish(run.checkpoint(!s.strip));
  return run.steps() < s.steps && signal ? 128 + signal : 0;
}
