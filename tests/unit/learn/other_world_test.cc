// A world that nothing but its own header knows of learns by imitation and by PPO, and its checkpoints come back.
#include <gtest/gtest.h>

#include <string>

#include "helpers/corridor.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/imitate.h"
#include "learn/ppo/ppo.h"
#include "play/evaluate.h"

namespace synpo {
namespace {

const Corridor& corridor() {
  static const Corridor world;
  return world;
}

std::string expert_lines(int count) {
  std::string lines;
  for (int i = 0; i < count; ++i)
    lines += format_trajectory(expert_episode(corridor(), {0, i % 2}, 1, i, 0.2, 1)) + "\n";
  return lines;
}

ImitationOptions small_options(bool single_steps) {
  ImitationOptions options = recipe(single_steps ? "fast" : "paper");
  PolicyShape& sizes = options.network;
  sizes.feature = sizes.basis = sizes.embedding = sizes.hidden = 8;
  options.memory = 6;
  options.fill = 4;
  options.trajectories = 5;
  if (!single_steps) return options;
  options.batch_states = 20;
  options.running = 24;
  options.warm_up = 2;
  return options;
}

Checkpoint as_read(const Checkpoint& checkpoint) {
  return read_text(format_checkpoint(checkpoint), [](Input& in) { return read_checkpoint(in); });
}

class OtherWorldImitation : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(SingleSteps, OtherWorldImitation, testing::Bool());

TEST_P(OtherWorldImitation, StoppedAndResumedIsUnbroken) {
  TemporaryFolder folder;
  const std::string path = folder.file("stream", expert_lines(30));
  Parallel parallel(2);
  Input input(path), again(path);
  Imitation run(corridor(), parallel, "synpo", small_options(GetParam()), {}, 3);
  run.set_total_updates(12);
  TrajectoryStream stream(input, corridor(), run.allowed(), run.window());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(run.update(stream));
  Imitation resumed(corridor(), parallel, as_read(run.checkpoint(true)));
  TrajectoryStream rest(again, corridor(), resumed.allowed(), resumed.window());
  rest.skip(resumed.stream_lines(), resumed.stream_hash());
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(run.update(stream) && resumed.update(rest));
  EXPECT_TRUE(format_checkpoint(resumed.checkpoint(true)) == format_checkpoint(run.checkpoint(true)));
}

TEST(OtherWorld, ItsTasksAreLearned) {
  TemporaryFolder folder;
  Parallel parallel(2);
  Input input(folder.file("stream", expert_lines(40)));
  ImitationOptions options = small_options(true);
  options.fill = 40;
  options.memory = 40;
  options.balance = 1;
  options.balance_final = 0;
  options.learning_rate = 0.01;
  Imitation run(corridor(), parallel, "synpo", options, {}, 3);
  run.set_total_updates(60);
  TrajectoryStream stream(input, corridor(), {}, -1);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(run.update(stream));
  const Model model = load_model(as_read(run.checkpoint(false)), corridor());
  model.engine->prepare_inference(parallel, model.parameters.data(), model.statistics.data(), {{0, 0}, {0, 1}});
  std::vector<EvalEpisode> episodes;
  for (int i = 0; i < 40; ++i) episodes.push_back({i % 2, i});
  for (const Outcomes& result :
       evaluate(parallel, *model.engine, corridor(), {{0, 0}, {0, 1}}, listed(episodes), {1, model.window, 0}))
    EXPECT_EQ(result.successes, 20);
}

TEST(OtherWorld, PpoStoppedAndResumedIsUnbroken) {
  Parallel parallel(2);
  PpoOptions options;
  options.lanes = 3;
  options.rollout = 8;
  options.minibatches = 2;
  options.value_hidden = 6;
  Model model = fresh_model("synpo", small_options(true).shape(corridor()), {3, 1});
  model.seen = {{0, 0}, {0, 1}};
  Ppo run(corridor(), parallel, std::move(model), options, 5);
  for (int i = 0; i < 3; ++i) run.update();
  const Checkpoint saved = as_read(run.checkpoint(true));
  Ppo resumed(corridor(), parallel, load_model(saved, corridor()), options, 5);
  resumed.resume(saved);
  for (int i = 0; i < 3; ++i) {
    run.update();
    resumed.update();
  }
  EXPECT_TRUE(format_checkpoint(resumed.checkpoint(true)) == format_checkpoint(run.checkpoint(true)));
}

}  // namespace
}  // namespace synpo
