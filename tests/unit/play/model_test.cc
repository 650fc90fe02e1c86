#include "play/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "format/safetensors.h"
#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/recipe.h"
#include "play/stream.h"

namespace synpo {
namespace {

Checkpoint golden() {
  Input input("tests/data/v1/checkpoint.safetensors");
  return read_checkpoint(input);
}

TEST(GoldenV1, TheModelGivesTheScoresItGave) {
  const Checkpoint checkpoint = golden();
  const std::unique_ptr<World> world = world_of(checkpoint);
  Model model = load_model(checkpoint, *world);
  EXPECT_EQ(model.seen, (std::vector<EnvTask>{{0, 0}, {0, 3}, {1, 1}, {2, 19}}));
  EXPECT_TRUE(model.is_seen({1, 1}));
  EXPECT_FALSE(model.is_seen({1, 2}));
  Parallel parallel(1);
  model.policy->prepare_inference(parallel, model.parameters.data(), model.statistics.data(),
                                  {{0, 0}, {2, 19}, {1, 7}});
  const float want[3][5] = {{0.0212015f, -0.3105655f, -0.2263175f, -0.4960039f, -0.2681035f},
                            {0.0613570f, -0.1689385f, -0.2895320f, -0.6345289f, -0.2127910f},
                            {-0.0799844f, -0.1513789f, -0.1926890f, -0.5404129f, -0.1690710f}};
  for (int i = 0; i < 3; ++i) {
    const EnvTask pair = i == 0 ? EnvTask{0, 0} : i == 1 ? EnvTask{2, 19} : EnvTask{1, 7};
    const std::vector<uint8_t> pictures = pictures_of(
        as_gridworld(*world, "this").maze(pair.env),
        {to_grid_state(episode_start(builtin_world(), {0, 0}, 1, Purpose::kEvaluation, i)).now}, model.window);
    float scores[5];
    model.policy->infer(0, 1, pictures.data(), &i, scores);
    for (int a = 0; a < 5; ++a) EXPECT_NEAR(scores[a], want[i][a], 1e-5) << i << " " << a;
  }
}

TEST(Model, ComesBack) {
  const Checkpoint checkpoint = golden();
  const std::unique_ptr<World> world = world_of(checkpoint);
  const Model model = load_model(checkpoint, *world);
  Checkpoint again = describe_model(model, *world);
  again.options = checkpoint.options;
  add_tensors(again.file, "", model.policy->parameters(), model.parameters.data());
  add_tensors(again.file, "", model.policy->statistics(), model.statistics.data());
  // Sizes that came later are the only difference.
  for (const char* name : {"action_embedding", "head_hidden", "seam", "sf_loss"})
    EXPECT_EQ(again.shape.erase(name), 1u) << name;
  SafeTensors written = read_text(format_checkpoint(again), [](Input& input) { return read_safetensors(input); });
  EXPECT_EQ(written.metadata.erase("written_by"), 1u);  // the first ones did not say it
  EXPECT_TRUE(format_safetensors(written) == contents("tests/data/v1/checkpoint.safetensors")) << "bytes differ";
}

TEST(Model, RefusesCheckpointsThatDoNotFit) {
  const auto refused = [](const std::function<void(Checkpoint&)>& change) {
    Checkpoint checkpoint = golden();
    change(checkpoint);
    const std::string message = thrown([&] {
      const std::unique_ptr<World> world = world_of(checkpoint);
      load_model(checkpoint, *world);
    });
    // What is wrong with its data is said of its file.
    const std::string file = "65 cannot read tests/data/v1/checkpoint.safetensors: ";
    return message.starts_with(file) ? "65 " + message.substr(file.size()) : "of no file: " + message;
  };
  EXPECT_EQ(refused([](Checkpoint&) {}), "of no file: nothing thrown");
  EXPECT_EQ(refused([](Checkpoint& c) { c.world = "house"; }),
            "65 world 'house', this build has gridworld and kitchen");
  EXPECT_EQ(refused([](Checkpoint& c) { c.rules = 2; }), "65 rules version 2, this build has 1");
  EXPECT_EQ(refused([](Checkpoint& c) { c.envs[1].hash ^= 1; }), "65 env 'map2': content and hash differ");
  EXPECT_EQ(refused([](Checkpoint& c) { c.envs[1].name = "map1"; }), "65 two environments are named 'map1'");
  EXPECT_TRUE(refused([](Checkpoint& c) {
                c.envs[1].content += c.envs[1].content;
              }).starts_with("65 env 'map2': found 32 lines"));
  EXPECT_EQ(refused([](Checkpoint& c) { c.envs.clear(); }), "65 the checkpoint has no environment");
  EXPECT_EQ(refused([](Checkpoint& c) { c.envs.pop_back(); }), "65 the network's shape does not fit the world");
  EXPECT_EQ(refused([](Checkpoint& c) { c.tasks.pop_back(); }), "65 the checkpoint's tasks are not this build's");
  EXPECT_EQ(refused([](Checkpoint& c) { c.method = "dqn"; }),
            "65 unknown method 'dqn', expected synpo, mlp, mtl, modulenet or sf");
  EXPECT_EQ(refused([](Checkpoint& c) { c.method = "mlp"; }), "65 no tensor 'policy.hidden.weight'");
  EXPECT_EQ(refused([](Checkpoint& c) { c.seen[0].first = "map9"; }),
            "65 metadata 'seen': found the env 'map9', expected one of the world 'gridworld', such as 'map1'");
  EXPECT_EQ(refused([](Checkpoint& c) { c.shape.erase("basis"); }), "65 the shape has no 'basis'");
  EXPECT_EQ(refused([](Checkpoint& c) { c.shape["hidden"] = 0; }),
            "65 shape 'hidden': found 0, expected a whole number from 1 to 65536");
  EXPECT_EQ(refused([](Checkpoint& c) { c.shape["hidden"] = 9; }),
            "65 tensor 'alpha.hidden.weight': found shape [8, 8], expected [8, 9]");
  EXPECT_EQ(refused([](Checkpoint& c) {
              std::swap(c.file.tensors.at("embedding.task").shape[0], c.file.tensors.at("embedding.task").shape[1]);
            }),
            "65 tensor 'embedding.task': found shape [4, 20], expected [20, 4]");
  EXPECT_EQ(refused([](Checkpoint& c) { c.shape["actions"] = 6; }), "65 the network's shape does not fit the world");
  EXPECT_EQ(refused([](Checkpoint& c) { c.file.tensors.erase("theta"); }), "65 no tensor 'theta'");
  EXPECT_EQ(refused([](Checkpoint& c) {
              std::vector<float> bias = c.file.get<float>("policy.bias");
              bias[3] = std::numeric_limits<float>::quiet_NaN();
              c.file.add("policy.bias", {5}, bias.data(), 5);
            }),
            "65 tensor 'policy.bias' holds a value that is not finite");
}

}  // namespace
}  // namespace synpo
