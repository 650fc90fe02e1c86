// A checkpoint on stdin, fine-tuned by PPO, a checkpoint on stdout.
#include <cstdint>
#include <string>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "base/text.h"
#include "finetune/finetune.h"
#include "learn/ppo/ppo_options.h"
#include "learn/ppo/tuning.h"
#include "play/world_factory.h"

using namespace synpo;

int ppo(int argc, char** argv) {
  TuningSettings s;
  std::string init;
  s.world = "gridworld";
  const std::string worlds =
      concat("with --init: ", alternatives(world_names()), "; else the folder of the checkpoint's scenes");
  Options options("synpo-finetune ppo", "[--steps N] [OPTION]... < CHECKPOINT > CHECKPOINT",
                  "Fine-tunes a policy by its reward.");
  options.text('c', "checkpoint", "FILE", "the trained policy", s.checkpoint)
      .integer(0, "steps", "N", "steps of all worlds together, such as 2e7", s.steps, 1, INT64_MAX)
      .text('p', "pairs", "FILE", "the pairs to learn on: TSV env, task, seen (the seen ones of the checkpoint)",
            s.pairs)
      .text(0, "resume", "FILE",
            "go on from a checkpoint of --save, to the same bits; the other options must be the same", s.resume)
      .choice(0, "init", "random", "from scratch: a network of random weights, for -w and -m", init, {"random"})
      .text('w', "world", "WORLD", worlds, s.world)
      .text('m', "method", "NAME", "with --init: the method", s.method);
  s.add_to(options);
  s.ppo.add_to(options);
  options.parse(argc, argv);
  s.random = options.given("init");
  if (s.random && options.given("checkpoint")) fail(Exit::kUsage, "-c and --init exclude each other");
  if (!s.random && options.given("method")) fail(Exit::kUsage, "-m goes with --init");
  if (!options.given("world") && (!s.random || options.given("resume"))) s.world.clear();

  catch_stop_signals();
  Parallel parallel(s.threads);
  Tuning tuning(s, options, parallel);
  return s.drive("synpo-finetune", tuning);
}
