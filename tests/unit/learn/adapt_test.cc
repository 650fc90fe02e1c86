#include "learn/adapt.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "helpers/policy_fixture.h"
#include "helpers/table_helpers.h"
#include "helpers/targets.h"

namespace synpo {
namespace {

Model trained_on(const World& world, std::vector<EnvTask> seen, PolicyShape shape = tiny_shape(false)) {
  shape.envs = world.envs();
  shape.tasks = world.task_count();
  Model model = fresh_model("synpo", shape, {3, 1});
  model.seen = std::move(seen);
  return model;
}

GridSet first_mazes(int count) {
  std::vector<Maze> mazes = open_mazes("gridworld");
  mazes.erase(mazes.begin() + count, mazes.end());
  return GridSet(std::move(mazes));
}

Episode demonstration(const GridSet& world, EnvTask pair, int64_t number = 0) {
  return replay(world, expert_episode(world, pair, 1, number, 0, 1));
}

std::vector<float> tensor(const Model& model, const std::string& name) {
  const TensorInfo& info = *model.policy->parameters().find(name);
  return {model.parameters.data() + info.offset, model.parameters.data() + info.offset + info.size};
}

// Rows of a table that differ.
std::vector<int> changed_rows(const std::vector<float>& a, const std::vector<float>& b, int width) {
  std::vector<int> rows;
  for (size_t row = 0; row * width < a.size(); ++row)
    if (!std::equal(a.begin() + row * width, a.begin() + (row + 1) * width, b.begin() + row * width))
      rows.push_back(int(row));
  return rows;
}

TEST(Adapt, NewEmbeddingsAreLearnedAndNothingElseMovesByABit) {
  const GridSet world = first_mazes(4);
  Parallel parallel(2);
  const Model start = widen(trained_on(world, {{0, 0}, {1, 1}, {2, 0}}), world, world, 1, 5);
  AdaptOptions options;
  options.adam.learning_rate = 0.03;
  options.adam.weight_decay = 0;
  Adaptation adaptation(world, parallel, widen(start, world, world, 1, 5), options, 5);
  EXPECT_EQ(adaptation.new_envs(), 1);
  EXPECT_EQ(adaptation.new_tasks(), world.task_count() - 2);
  for (const EnvTask& pair : {EnvTask{3, 0}, EnvTask{1, 6}, EnvTask{3, 6}}) adaptation.add(demonstration(world, pair));
  const Losses first = adaptation.update();
  for (int i = 0; i < 200; ++i) adaptation.update();
  EXPECT_LT(adaptation.update().policy, first.policy);
  const Model& after = adaptation.model();
  const int width = after.shape.embedding;
  EXPECT_EQ(changed_rows(tensor(start, "embedding.env"), tensor(after, "embedding.env"), width), (std::vector<int>{3}));
  for (const int row : changed_rows(tensor(start, "embedding.task"), tensor(after, "embedding.task"), width))
    EXPECT_GT(row, 1);
  for (const TensorInfo& info : after.policy->parameters().tensors()) {
    if (info.name.starts_with("embedding.")) continue;
    EXPECT_EQ(tensor(after, info.name), tensor(start, info.name)) << info.name;
  }
  EXPECT_EQ(std::vector<float>(after.statistics.data(), after.statistics.data() + after.policy->statistics().total()),
            std::vector<float>(start.statistics.data(), start.statistics.data() + start.policy->statistics().total()));
  EXPECT_TRUE(after.is_seen({3, 6}));
}

// Losses of some updates, and the embeddings and recognisers after them, from demonstrations of which some come later
// than others, some are of one pair, and old and new environments and tasks stand together in every way.
struct Updates {
  std::vector<double> losses;
  std::vector<float> embeddings, recognisers;
};

Updates updates(const PolicyShape& shape, bool recognisers, int threads, size_t memory_bytes) {
  const GridSet world = first_mazes(6);
  Parallel parallel(threads);
  AdaptOptions options;
  options.trajectories = 12;
  options.adam.learning_rate = 0.03;
  options.losses = {0.5, 0.3, 0.2};
  options.memory_bytes = memory_bytes;
  options.targets.recognisers = recognisers;
  const Model start = trained_on(world, {{0, 0}, {1, 1}, {2, 0}, {3, 1}, {5, 7}}, shape);
  Adaptation adaptation(world, parallel, widen(start, world, world, 1, 5), options, 5);
  for (int i = 0; i < 6; ++i) adaptation.add(demonstration(world, {i, (i * i) % 4}));
  Updates result;
  for (int i = 0; i < 6; ++i) {
    if (i == 3)
      for (const EnvTask& pair : {EnvTask{4, 0}, {4, 9}, {2, 9}}) adaptation.add(demonstration(world, pair, 1));
    const Losses losses = adaptation.update();
    for (const double loss : {losses.total, losses.policy, losses.reward, losses.env, losses.task})
      result.losses.push_back(loss);
  }
  const auto take = [&](ParameterGroup group, std::vector<float>& values) {
    for (const TensorInfo* info : adaptation.model().policy->group(group))
      for (const float value : tensor(adaptation.model(), info->name)) values.push_back(value);
  };
  take(ParameterGroup::kEmbeddings, result.embeddings);
  take(ParameterGroup::kRecognisers, result.recognisers);
  const std::vector<float> before = tensor(widen(start, world, world, 1, 5), "embedding.env"),
                           after = tensor(adaptation.model(), "embedding.env");
  EXPECT_EQ(changed_rows(before, after, shape.embedding), std::vector<int>{4});
  return result;
}

TEST(Adapt, WhatIsKeptOfTheHeadGivesWhatTheWholeHeadDoes) {
  for (const bool general : {false, true})
    for (const bool normalise : {false, true}) {
      const bool recognisers = general != normalise;
      SCOPED_TRACE(testing::Message() << "general form " << general << ", normalised embeddings " << normalise
                                      << ", recognisers learned " << recognisers);
      PolicyShape shape = tiny_shape(false);
      shape.action_embedding = general ? 3 : 0;
      shape.normalise_embeddings = normalise;
      for_every_target([&](const std::string&) {
        const double limit = 1e-6 + kernels<float>().product_error;
        const Updates whole = updates(shape, recognisers, 1, 0), kept = updates(shape, recognisers, 1, size_t(1) << 30);
        for (size_t i = 0; i < whole.losses.size(); ++i)
          EXPECT_NEAR(kept.losses[i], whole.losses[i], limit * whole.losses[i]) << i;
        EXPECT_LT(relative_error(kept.embeddings, whole.embeddings), limit);
        EXPECT_LT(relative_error(kept.recognisers, whole.recognisers), limit);
        EXPECT_NE(kept.embeddings, whole.embeddings) << "the same way twice?";
        const Updates threads = updates(shape, recognisers, 2, size_t(1) << 30);
        EXPECT_EQ(threads.embeddings, kept.embeddings) << "threads show";
        EXPECT_EQ(threads.recognisers, kept.recognisers) << "threads show";
      });
    }
}

TEST(Adapt, MoreIsLearnedWhereAskedFor) {
  const GridSet world = first_mazes(3);
  Parallel parallel(1);
  AdaptOptions options;
  options.targets = {true, true, true};
  const Model start = widen(trained_on(world, {{0, 0}, {1, 1}}), world, world, 1, 5);
  Adaptation adaptation(world, parallel, widen(start, world, world, 1, 5), options, 5);
  adaptation.add(demonstration(world, {2, 0}));
  adaptation.update();
  for (const char* name : {"theta", "policy.bias", "f_env.out.weight", "alpha.hidden.weight", "beta.out.weight"})
    EXPECT_NE(tensor(adaptation.model(), name), tensor(start, name)) << name;
  EXPECT_EQ(tensor(adaptation.model(), "encoder.fc.weight"), tensor(start, "encoder.fc.weight"));
}

// Each word unfreezes what it names, and nothing else.
TEST(Adapt, LearnedIsWhatIsNamed) {
  const GridSet world = first_mazes(3);
  Parallel parallel(1);
  const Model start = widen(trained_on(world, {{0, 0}, {1, 1}}), world, world, 1, 5);
  const auto learned = [&](const AdaptTargets& targets) {
    AdaptOptions options;
    options.targets = targets;
    Adaptation adaptation(world, parallel, widen(start, world, world, 1, 5), options, 5);
    adaptation.add(demonstration(world, {2, 0}));
    adaptation.update();
    std::string names;
    for (const char* name : {"embedding.env", "theta", "policy.bias", "f_env.out.weight", "f_task.hidden.weight",
                             "alpha.hidden.weight", "encoder.fc.weight"})
      if (tensor(adaptation.model(), name) != tensor(start, name)) names += std::string(" ") + name;
    return names;
  };
  EXPECT_EQ(learned({}), " embedding.env");
  EXPECT_EQ(learned({.recognisers = true}), " embedding.env f_env.out.weight f_task.hidden.weight");
  EXPECT_EQ(learned({.basis = true}), " embedding.env theta policy.bias");
  EXPECT_EQ(learned({.coefficients = true}), " embedding.env alpha.hidden.weight");
}

TEST(Adapt, AWiderWorldKeepsWhatItKnows) {
  const GridSet few = first_mazes(2);
  const GridSet many = GridSet::open("gridworld");
  const Model small = trained_on(few, {{0, 0}, {1, 2}});
  const Model wide = widen(small, few, many, 1, 5);
  EXPECT_EQ(wide.shape.envs, many.envs());
  const std::vector<float> before = tensor(small, "embedding.env"), after = tensor(wide, "embedding.env");
  for (int env = 0; env < few.envs(); ++env) {
    const int place = many.env_index(few.maze(env).name), width = small.shape.embedding;
    EXPECT_TRUE(
        std::equal(before.begin() + env * width, before.begin() + (env + 1) * width, after.begin() + place * width));
  }
  EXPECT_EQ(tensor(wide, "theta"), tensor(small, "theta"));
  EXPECT_TRUE(wide.is_seen({many.env_index(few.maze(1).name), 2}));
  EXPECT_THROW(widen(small, few, first_mazes(1), 1, 5), Error);
}

TEST(Adapt, DemonstrationsThatThereIsNoRoomForAreRefused) {
  const GridSet world = first_mazes(4);
  Parallel parallel(1);
  const Episode episode = demonstration(world, {3, 0});
  AdaptOptions options;
  options.most_bytes = 2 * episode.actions.size() * world.observation_size();
  Adaptation adaptation(world, parallel, widen(trained_on(world, {{0, 0}}), world, world, 1, 5), options, 5);
  for (int i = 0; i < 2; ++i) adaptation.add(episode);
  EXPECT_EQ(thrown([&] { adaptation.add(episode); }),
            concat("65 the demonstrations have more than ", 2 * episode.actions.size(),
                   " steps, as many as there is room for: give fewer of them"));
  EXPECT_EQ(adaptation.demonstrations(), 2u);
}

TEST(Adapt, ThreadsDoNotShow) {
  const GridSet world = first_mazes(3);
  std::vector<std::string> bytes;
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    Adaptation adaptation(world, parallel, widen(trained_on(world, {{0, 0}, {1, 1}}), world, world, 1, 5), {}, 5);
    for (int task = 0; task < 4; ++task) adaptation.add(demonstration(world, {2, task}));
    for (int i = 0; i < 5; ++i) adaptation.update();
    bytes.push_back(format_checkpoint(adaptation.checkpoint({{"task-loss", "1"}})));
  }
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

}  // namespace
}  // namespace synpo
