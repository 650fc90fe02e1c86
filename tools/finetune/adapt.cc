// Demonstrations in, an adapted checkpoint out.
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "advice.h"
#include "base/cli/options.h"
#include "base/cli/progress.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "base/text.h"
#include "engine/device.h"
#include "finetune/finetune.h"
#include "format/checkpoint.h"
#include "learn/adapt.h"
#include "play/episode.h"
#include "play/model.h"
#include "play/stream.h"
#include "play/world_factory.h"
#include "policy/losses.h"
#include "world/world.h"

using namespace synpo;

namespace {

// The checkpoint's environments, and those of `more` that it has not.
std::unique_ptr<World> wider_world(const World& world, const World* more, const std::string& name) {
  std::vector<Environment> environments = world.environments();
  if (more) {
    if (more->name() != world.name())
      fail(Exit::kUsage, "the checkpoint is of ", world.name(), ", -w names ", more->name());
    for (const Environment& env : more->environments()) {
      const int known = world.env_index(env.name);
      if (known < 0)
        environments.push_back(env);
      else if (world.environments()[known].hash != env.hash)
        fail(Exit::kData, "environment ", quoted(env.name), " of ", quoted(name), " is another one in the checkpoint");
    }
  }
  return restore_world(world.name(), environments, more);
}

// "embeddings+recognisers+basis". "heads" is the older name of these two together.
AdaptTargets parse_targets(const std::string& list) {
  AdaptTargets targets;
  const std::string text = list + "+";
  size_t begin = 0, count = 0;
  for (size_t end; (end = text.find('+', begin)) != std::string::npos; begin = end + 1, ++count) {
    const std::string word = text.substr(begin, end - begin);
    const bool both = word == "heads";
    if (count == 0 && word == "embeddings") continue;
    if (count > 0 && (both || word == "recognisers" || word == "basis")) {
      targets.recognisers |= both || word == "recognisers";
      targets.basis |= both || word == "basis";
    } else if (count > 0 && word == "coefficients") {
      targets.coefficients = true;
    } else {
      throw std::invalid_argument("expected embeddings, and +recognisers, +basis or +coefficients after it");
    }
  }
  return targets;
}

}  // namespace

int adapt(int argc, char** argv) {
  AdaptOptions adaptation;
  std::string checkpoint_path, world_name, output_path = "-";
  uint64_t seed = 1;
  int64_t updates = 10000;
  int threads = 0;
  bool expect_end = false, force = false, quiet = false;
  DeviceOptions device;
  Options options(
      "synpo-finetune adapt", "-c CHECKPOINT [OPTION]... [DEMONSTRATIONS]... > CHECKPOINT",
      "Learns embeddings of environments and tasks that no seen pair of the checkpoint has; all else stays as it is.");
  options.text('c', "checkpoint", "FILE", "the trained policy", checkpoint_path)
      .text('w', "world", "WORLD", concat("new environments too: ", alternatives(world_names())), world_name)
      .suggest(world_kinds())
      .integer('n', "count", "N", "updates", updates, 1, INT64_MAX)
      .integer(0, "trajectories", "N", "demonstrations of an update, drawn anew for each", adaptation.trajectories, 1,
               100000)
      .call(0, "train", "WHAT", "embeddings, and after it any of +recognisers, +basis and +coefficients [embeddings]",
            [&](const std::string& list) { adaptation.targets = parse_targets(list); })
      .real(0, "lr", "X", "learning rate of Adam", adaptation.adam.learning_rate, 0, 1)
      .real(0, "weight-decay", "X", "L2 term added to the gradient", adaptation.adam.weight_decay, 0, 1)
      .real(0, "reward-loss", "X", "weight of reward prediction", adaptation.losses.reward, 0, 1e6)
      .real(0, "env-loss", "X", "weight of environment disentanglement", adaptation.losses.env, 0, 1e6)
      .real(0, "task-loss", "X", "weight of task disentanglement", adaptation.losses.task, 0, 1e6)
      .real(0, "embedding-sd", "X", "new embeddings start as N(0, X^2); 0: Xavier uniform", adaptation.embedding_sd, 0,
            1000)
      .flag(0, "expect-end", "a stream that does not say its end in a last line is an error", expect_end)
      .seed(seed)
      .threads(threads);
  device.add_to(options);
  options.text('o', "output", "FILE", "write the checkpoint to FILE", output_path)
      .flag('f', "force", "write the checkpoint to a terminal", force)
      .quiet(quiet);
  const std::vector<std::string> files = options.parse(argc, argv, 0, kMostStreamFiles);
  if (checkpoint_path.empty()) fail(Exit::kUsage, "-c CHECKPOINT is missing");

  catch_stop_signals();
  Parallel parallel(threads);
  const Checkpoint checkpoint = load_checkpoint(checkpoint_path);
  const std::unique_ptr<World> more = world_name.empty() ? nullptr : open_world(world_name);
  const std::unique_ptr<World> from = world_of(checkpoint, more.get());
  const Model model = load_model(checkpoint, *from);
  const std::unique_ptr<World> world = wider_world(*from, more.get(), world_name);
  Model wide = widen(model, *from, *world, adaptation.embedding_sd, seed);
  compute_on(device, parallel, wide);
  Adaptation adapted(*world, parallel, std::move(wide), adaptation, seed);
  Output output(output_path, Output::Kind::kBinary, force);
  Input input(files);
  TrajectoryStream stream(input, *world, {}, model.window);
  while (const std::optional<Episode> episode = stream.next()) adapted.add(*episode);
  if (expect_end) stream.check_end();
  if (adapted.demonstrations() == 0) fail(Exit::kData, input.whole_name(), " has no trajectory");
  Progress progress("synpo-finetune", "updates", uint64_t(updates), quiet);
  if (stream.tested_start()) progress.warn(words(*stream.tested_start()));
  progress.say(concat(counted(adapted.demonstrations(), "demonstration"), ", ",
                      counted(adapted.new_envs(), "new environment"), ", ", counted(adapted.new_tasks(), "new task")));
  for (int64_t i = 0; i < updates; ++i) {
    const Losses losses = adapted.update();
    progress.update(uint64_t(i + 1), "loss " + std::to_string(losses.total).substr(0, 5));
    stop_if_asked();
  }
  progress.finish();
  output.write(format_checkpoint(adapted.checkpoint(checkpoint.options)));
  output.finish();
  return 0;
}
