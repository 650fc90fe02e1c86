// A checkpoint in, the same fine-tuned by PPO out.
#include <cstdint>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "base/text.h"
#include "finetune/finetune.h"
#include "going_on.h"
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
  Options options("synpo-finetune ppo", "[--steps N] [OPTION]... [CHECKPOINT] > CHECKPOINT",
                  "Fine-tunes a policy by its reward.");
  options.text('c', "checkpoint", "FILE", "the trained policy", s.checkpoint)
      .integer(0, "steps", "N", "steps of all worlds together, such as 2e7", s.steps, 1, INT64_MAX)
      .text('p', "pairs", "FILE", "the pairs to learn on: TSV env, task, seen (the seen ones of the checkpoint)",
            s.pairs)
      .text(0, "resume", "FILE",
            "go on from a checkpoint of --save, to the same bits; the other options must be the same", s.resume)
      .choice(0, "init", "random", "from scratch: a network of random weights, for -w and -m", init, {"random"})
      .text('w', "world", "WORLD", worlds, s.world)
      .suggest(world_kinds())
      .text('m', "method", "NAME", "with --init: the method", s.method);
  s.add_to(options);
  s.ppo.add_to(options);
  const std::vector<std::string> files = options.parse(argc, argv, 0, 1);
  s.random = options.given("init");
  if (s.random && (options.given("checkpoint") || !files.empty()))
    fail(Exit::kUsage, files.empty() ? "-c" : "a checkpoint", " and --init exclude each other");
  s.checkpoint = one_file(options, "checkpoint", s.checkpoint, files);
  if (!s.random && options.given("method")) fail(Exit::kUsage, "-m goes with --init");
  if (!options.given("world") && (!s.random || options.given("resume"))) s.world.clear();

  catch_stop_signals();
  Parallel parallel(s.threads);
  Tuning tuning(s, options, parallel);
  const int code = s.drive("synpo-finetune", tuning);
  if (code != 0) tell_how_to_go_on("synpo-finetune", s, options, {"checkpoint"}, {false, {}});
  return code;
}
