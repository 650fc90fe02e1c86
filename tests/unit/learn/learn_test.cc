#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/recipe.h"
#include "play/model.h"
#include "play/stream.h"

namespace synpo {
namespace {

std::string line_of(const Trajectory& trajectory) { return format_trajectory(trajectory); }

TEST(Expert, GoesStraightToSuccess) {
  const GridSet& world = builtin_world();
  for (int i = 0; i < 200; ++i) {
    const EnvTask pair = {i % world.envs(), i * 7 % world.task_count()};
    const Trajectory t = expert_episode(world, pair, 5, i, 0, 2);
    EXPECT_EQ(t.env, world.maze(pair.env).name);
    EXPECT_EQ(t.task, world.tasks()[pair.task].name());
    EXPECT_EQ(t.env_hash, world.maze(pair.env).hash);
    EXPECT_EQ(t.window, 2);
    EXPECT_EQ(t.seed, 5u);
    EXPECT_EQ(t.episode, i);
    EXPECT_TRUE(t.success && t.terminated && !t.truncated);
    EXPECT_TRUE(t.labels.empty());
    const GridState start = to_grid_state(episode_start(world, pair, 5, Purpose::kEpisodeStart, i));
    EXPECT_EQ(int(t.actions.size()), world.planner(pair.env).steps_to_success(world.tasks()[pair.task], start));
    EXPECT_EQ(t.start.at("agent"), (std::pair{start.now.agent / 16, start.now.agent % 16}));
    EXPECT_EQ(t.start.at("P"), (std::pair{start.now.treasures[4] / 16, start.now.treasures[4] % 16}));
    EXPECT_EQ(t.start.size(), 6u);
  }
}

TEST(Expert, NoiseTakesOtherMovesAndKeepsTheLabels) {
  const GridSet& world = builtin_world();
  int moves = 0, other = 0, picks = 0;
  for (int i = 0; i < 300; ++i) {
    const EnvTask pair = {i % world.envs(), i % world.task_count()};
    const Episode played = expert(pair, i, 0.4);
    GridState state = to_grid_state(played.start);
    for (size_t t = 0; t < played.actions.size(); ++t) {
      ASSERT_EQ(played.labels[t], world.planner(pair.env).action(world.tasks()[pair.task], state));
      if (played.labels[t] != kPick) {
        ++moves;
        other += played.actions[t] != played.labels[t];
        picks += played.actions[t] == kPick;
      }
      grid_step(world.maze(pair.env), world.tasks()[pair.task], state, played.actions[t]);
    }
  }
  EXPECT_EQ(picks, 0);
  EXPECT_NEAR(double(other) / moves, 0.4 * 3 / 4, 0.015);  // a quarter of the random moves is the expert's
}

TEST(Expert, AnEpisodeIsTheSameWhateverElseIsAsked) {
  const GridSet& world = builtin_world();
  const GridSet few({builtin_mazes()[0], builtin_mazes()[1]});
  const std::string alone = line_of(expert_episode(world, {1, 3}, 7, 11, 0.3, 1));
  std::set<std::string> others;
  for (int i = 0; i < 20; ++i) others.insert(line_of(expert_episode(world, {1, 3}, 7, i, 0.3, 1)));
  EXPECT_EQ(others.size(), 20u);
  EXPECT_EQ(others.count(alone), 1u);
  EXPECT_EQ(line_of(expert_episode(few, {1, 3}, 7, 11, 0.3, 1)), alone);
  // Noise changes the way, not the start.
  EXPECT_EQ(expert_episode(world, {1, 3}, 7, 11, 0, 1).start, expert_episode(world, {1, 3}, 7, 11, 0.3, 1).start);
  EXPECT_NE(expert_episode(world, {1, 3}, 8, 11, 0, 1).start, expert_episode(world, {1, 3}, 7, 11, 0, 1).start);
  EXPECT_NE(expert_episode(world, {1, 4}, 7, 11, 0, 1).start, expert_episode(world, {1, 3}, 7, 11, 0, 1).start);
  // Starts of the evaluation are others than those of the training.
  EXPECT_NE(episode_start(world, {1, 3}, 7, Purpose::kEvaluation, 11),
            episode_start(world, {1, 3}, 7, Purpose::kEpisodeStart, 11));
}

TEST(Replay, ComesBackThroughTheFile) {
  const GridSet& world = builtin_world();
  for (int i = 0; i < 100; ++i) {
    const EnvTask pair = {i % world.envs(), i % world.task_count()};
    const Trajectory t = expert_episode(world, pair, 2, i, i % 2 * 0.5, 1);
    const Episode episode = replay(world, parse_trajectory(line_of(t), kStepLimit));
    EXPECT_EQ(episode.pair, pair);
    EXPECT_EQ(episode.start, episode_start(world, pair, 2, Purpose::kEpisodeStart, i));
    EXPECT_EQ(episode.actions, t.actions);
    EXPECT_EQ(episode.labels, t.labels.empty() ? t.actions : t.labels);
  }
}

TEST(Replay, TruncatedEpisodesToo) {
  const GridSet& world = builtin_world();
  Trajectory t = expert_episode(world, {0, 0}, 1, 0, 0, 1);
  t.actions.assign(kStepLimit, kPick);
  t.start["agent"] = {1, 1};
  if (std::count_if(t.start.begin(), t.start.end(), [](const auto& entry) {
        return entry.second == std::pair{1, 1};
      }) > 1)
    FAIL() << "a treasure lies there";
  t.reward_cents.assign(kStepLimit, -1);
  t.terminated = t.success = false;
  t.truncated = true;
  EXPECT_EQ(replay(world, t).actions.size(), size_t(kStepLimit));
  t.truncated = false;
  EXPECT_EQ(thrown([&] { replay(world, t); }), "65 replay and file differ in success, terminated or truncated");
}

TEST(Replay, RefusesWhatIsNotThisWorlds) {
  const GridSet& world = builtin_world();
  const Trajectory good = expert_episode(world, {2, 0}, 1, 0, 0, 1);
  const auto refused = [&](const std::function<void(Trajectory&)>& change) {
    Trajectory t = good;
    change(t);
    return thrown([&] { replay(world, t); });
  };
  EXPECT_EQ(refused([](Trajectory&) {}), "nothing thrown");
  EXPECT_EQ(refused([](Trajectory& t) { t.world = "kitchen"; }), "65 world 'kitchen', expected 'gridworld'");
  EXPECT_EQ(refused([](Trajectory& t) { t.world = "kitchen", t.actions[0] = 6; }),
            "65 world 'kitchen', expected 'gridworld'");
  EXPECT_EQ(refused([](Trajectory& t) { t.actions[0] = 5; }),
            "65 field 'actions': found '5', expected a whole number from 0 to 4");
  EXPECT_EQ(refused([](Trajectory& t) { t.rules = 2; }), "65 rules version 2, this build has 1");
  EXPECT_EQ(refused([](Trajectory& t) { t.env = "map21"; }), "65 unknown env 'map21'");
  EXPECT_EQ(refused([](Trajectory& t) { t.task = "R-R"; }), "65 unknown task 'R-R'");
  EXPECT_EQ(refused([](Trajectory& t) { t.env = "map4"; }), "65 env 'map4' is not the one of that name here");
  for (const char* env : {"map21", "map4"}) {
    Trajectory t = good;
    t.env = env;
    EXPECT_TRUE(fails_for(kOtherWorld, [&] { replay(world, t); }));
  }
  EXPECT_EQ(refused([](Trajectory& t) { t.start.erase("G"); }), "65 field 'start': no place for 'G'");
  EXPECT_EQ(refused([](Trajectory& t) { t.start["Z"] = t.start["B"]; }),
            "65 field 'start': found 7 places, expected the agent's and those of 5 treasures");
  EXPECT_EQ(refused([](Trajectory& t) {
              t.start["B"] = {0, 3};
            }),
            "65 field 'start': 'B' at row 0, column 3 is not on the floor of map3");
  EXPECT_EQ(refused([](Trajectory& t) {
              t.start["agent"] = {1, 1 << 20};
            }),
            "65 field 'start': 'agent' at row 1, column 1048576 is not on the floor of map3");
  EXPECT_EQ(refused([](Trajectory& t) { t.start["B"] = t.start["P"]; }), "65 field 'start': two treasures on one cell");
  EXPECT_EQ(refused([](Trajectory& t) { t.reward_cents[5] = -1; }),
            "65 replay gives reward 0.99 at step 6, file says -0.01: other maps?");
  EXPECT_EQ(refused([](Trajectory& t) { t.reward_cents.back() = -1; }),
            concat("65 replay gives reward 10.99 at step ", good.actions.size(), ", file says -0.01: other maps?"));
  EXPECT_EQ(refused([](Trajectory& t) {
              t.actions.push_back(kUp);
              t.reward_cents.push_back(-1);
            }),
            concat("65 replay ends at step ", good.actions.size(), ", file goes on to ", good.actions.size() + 1));
  for (bool Trajectory::*flag : {&Trajectory::success, &Trajectory::terminated, &Trajectory::truncated})
    EXPECT_EQ(refused([&](Trajectory& t) { t.*flag = !(t.*flag); }),
              "65 replay and file differ in success, terminated or truncated");
}

TEST(Relabel, PutsTheExpertsLabels) {
  const GridSet& world = builtin_world();
  for (int i = 0; i < 50; ++i) {
    const Trajectory noisy = expert_episode(world, {i % world.envs(), i % world.task_count()}, 3, i, 0.5, 1);
    Trajectory bare = noisy;
    bare.labels.clear();
    EXPECT_EQ(line_of(relabelled(world, bare)), line_of(noisy));
    bare.labels.assign(bare.actions.size(), kPick);
    EXPECT_EQ(line_of(relabelled(world, bare)), line_of(noisy));
  }
  Trajectory damaged = expert_episode(world, {0, 0}, 3, 0, 0, 1);
  damaged.reward_cents[0] = 5;
  EXPECT_TRUE(thrown([&] { relabelled(world, damaged); }).starts_with("65 replay gives reward"));
}

TEST(ResolvePairs, ByName) {
  const std::vector<PairRow> rows = {{"map2", "R-B", true, ""}, {"map1", "P-O", false, ""}};
  EXPECT_EQ(resolve_pairs(builtin_world(), rows, false, "IN"), (std::vector<EnvTask>{{1, 0}, {0, 19}}));
  EXPECT_EQ(resolve_pairs(builtin_world(), rows, true, "IN"), (std::vector<EnvTask>{{1, 0}}));
  EXPECT_EQ(thrown([] {
              resolve_pairs(builtin_world(), {{"map0", "R-B", true, "", 7}}, false, "IN");
            }),
            "65 IN: line 7: found the env 'map0', expected one of the world 'gridworld', such as 'map1'");
  EXPECT_EQ(thrown([] {
              resolve_pairs(builtin_world(), {{"map1", "R", false, ""}}, true, "metadata 'seen'");
            }),
            "65 metadata 'seen': found the task 'R', expected one of the world 'gridworld', such as 'R-B'");
}

// Reads a stream to its end; the number of trajectories.
int read_stream(const std::string& text, const std::vector<EnvTask>& seen, int window = -1) {
  return read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), seen, window);
    int count = 0;
    while (stream.next()) ++count;
    EXPECT_TRUE(stream.ended());
    EXPECT_EQ(stream.lines(), uint64_t(count));
    EXPECT_EQ(stream.hash(), Hash().add(text.substr(0, input.offset())).value());
    return count;
  });
}

std::string stream_refused(const std::string& text, const std::vector<EnvTask>& seen, int window = -1) {
  return thrown([&] { read_stream(text, seen, window); });
}

TEST(Stream, ReadsHashesAndCounts) {
  EXPECT_EQ(read_stream(expert_lines({{0, 0}, {3, 4}}, 6), {}), 6);
  EXPECT_EQ(read_stream(expert_lines({{0, 0}, {3, 4}}, 6), {{0, 0}, {3, 4}, {5, 5}}), 6);
  EXPECT_EQ(read_stream("", {}), 0);
}

TEST(Stream, ErrorsNameTheLine) {
  const std::string two = expert_lines({{0, 0}}, 2);
  EXPECT_EQ(stream_refused(two + expert_lines({{0, 1}}, 1), {{0, 0}}),
            "65 IN: line 3: pair map1, B-G is not in the seen set");
  EXPECT_EQ(stream_refused(two + expert_lines({{0, 0}}, 1, 0, 2), {}),
            "65 IN: line 3: window 2, expected 1 as in the trajectories before");
  EXPECT_EQ(stream_refused(two, {}, 3), "65 IN: line 1: window 1, expected 3 as in the trajectories before");
  EXPECT_EQ(
      stream_refused(two + "{\"format\":", {}),
      "65 IN: line 3: found no JSON (byte 11: while parsing value - unexpected end of input; expected '[', '{', or a "
      "literal), expected a JSON object");
  EXPECT_EQ(stream_refused(two + "\n" + two, {}), "65 IN: line 3: found an empty line, expected a JSON object");
  std::string damaged = two;
  damaged.replace(damaged.rfind("10.99"), 5, "10.98");
  EXPECT_TRUE(stream_refused(damaged, {}).starts_with("65 IN: line 2: replay gives reward 10.99 at step "));
}

TEST(Stream, SkipsWhatWasRead) {
  const std::string text = expert_lines({{0, 0}, {3, 4}}, 6);
  uint64_t hash = 0;
  read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), {});
    for (int i = 0; i < 4; ++i) stream.next();
    hash = stream.hash();
    return 0;
  });
  read_text(text, [&](Input& input) {
    TrajectoryStream stream(input, builtin_world(), {});
    stream.skip(4, hash);
    EXPECT_EQ(stream.lines(), 4u);
    EXPECT_EQ(stream.next()->actions, expert({0, 0}, 4).actions);
    EXPECT_EQ(stream.next()->actions, expert({3, 4}, 5).actions);
    EXPECT_FALSE(stream.next());
    EXPECT_EQ(stream.hash(), Hash().add(text).value());
    return 0;
  });
  const auto skip_refused = [&](const std::string& other, uint64_t lines) {
    return read_text(other, [&](Input& input) {
      TrajectoryStream stream(input, builtin_world(), {});
      return thrown([&] { stream.skip(lines, hash); });
    });
  };
  EXPECT_EQ(skip_refused(expert_lines({{0, 0}, {3, 5}}, 6), 4),
            "65 IN: the first 4 lines are not those that the checkpoint was trained on");
  EXPECT_EQ(skip_refused(text, 3), "65 IN: the first 3 lines are not those that the checkpoint was trained on");
  EXPECT_EQ(skip_refused(expert_lines({{0, 0}, {3, 4}}, 3), 4),
            "65 IN: it ends at line 3, but the checkpoint has read 4 lines: another stream?");
}

TEST(Memory, KeepsTheLast) {
  ReplayMemory memory(5);
  for (int i = 0; i < 12; ++i) {
    memory.add(expert({0, i}, 0));
    EXPECT_EQ(memory.size(), size_t(std::min(i + 1, 5)));
  }
  std::set<int> tasks;
  for (size_t i = 0; i < memory.size(); ++i) {
    tasks.insert(memory[i].pair.task);
    EXPECT_EQ(memory.serial(i), uint64_t(memory[i].pair.task));
  }
  EXPECT_EQ(tasks, (std::set<int>{7, 8, 9, 10, 11}));
}

SafeTensors saved(const ReplayMemory& memory) {
  SafeTensors file;
  memory.save(file, "m/", builtin_world());
  return file;
}

TEST(Memory, ComesBack) {
  for (const int added : {0, 3, 5, 13}) {
    ReplayMemory memory(5), loaded(5);
    for (int i = 0; i < added; ++i) memory.add(expert({i % 20, i % 20}, i, 0.3));
    loaded.load(saved(memory), "m/", builtin_world());
    for (int more = 0; more < 3; ++more) {
      ASSERT_EQ(loaded.size(), memory.size());
      for (size_t i = 0; i < memory.size(); ++i) {
        EXPECT_EQ(loaded[i].pair, memory[i].pair);
        EXPECT_EQ(loaded[i].start, memory[i].start);
        EXPECT_EQ(loaded[i].actions, memory[i].actions);
        EXPECT_EQ(loaded[i].labels, memory[i].labels);
        EXPECT_EQ(loaded.serial(i), memory.serial(i));
      }
      loaded.add(expert({19, 19}, more));
      memory.add(expert({19, 19}, more));
    }
  }
}

TEST(Memory, RefusesWhatNoMemoryWrote) {
  ReplayMemory memory(5);
  for (int i = 0; i < 3; ++i) memory.add(expert({i, i}, i));
  const SafeTensors good = saved(memory);
  const auto refused = [&](const std::function<void(SafeTensors&)>& change) {
    SafeTensors file = good;
    change(file);
    ReplayMemory other(5);
    return thrown([&] { other.load(file, "m/", builtin_world()); });
  };
  const std::string malformed = "65 tensor 'm/episodes' is malformed";
  const std::vector<uint8_t> bytes = good.get<uint8_t>("m/episodes");
  for (size_t size = 1; size < bytes.size(); ++size)
    ASSERT_EQ(refused([&](SafeTensors& file) { file.add("m/episodes", {int64_t(size)}, bytes.data(), size); }),
              malformed)
        << size;
  for (const auto& [at, value] : {std::pair{0, 20}, {1, 1}, {2, 20}, {3, 0}, {4, 255}, {10, 2}, {11, 5}}) {
    std::vector<uint8_t> damaged = bytes;
    damaged[at] = uint8_t(value);
    EXPECT_EQ(refused([&](SafeTensors& file) {
                file.add("m/episodes", {int64_t(bytes.size())}, damaged.data(), bytes.size());
              }),
              malformed)
        << at;
  }
  const uint64_t serials[4] = {0, 1, 2, 3};
  EXPECT_EQ(refused([&](SafeTensors& file) { file.add("m/serials", {4}, serials, 4); }), malformed);
  for (const uint64_t added : {0, 2, 4, 100})
    EXPECT_EQ(refused([&](SafeTensors& file) { file.add("m/added", {1}, &added, 1); }), malformed) << added;
  EXPECT_EQ(refused([](SafeTensors& file) { file.tensors.erase("m/added"); }), "65 no tensor 'm/added'");
  ReplayMemory small(2);
  EXPECT_EQ(thrown([&] { small.load(good, "m/", builtin_world()); }), malformed);
}

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
  EXPECT_TRUE(format_checkpoint(again) == contents("tests/data/v1/checkpoint.safetensors")) << "bytes differ";
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

TEST(Recipe, ValuesOfTheSupplement) {
  const ImitationOptions paper = recipe("paper");
  EXPECT_EQ(paper.trajectories, 64);
  EXPECT_EQ(paper.batch_states, 0);
  EXPECT_EQ(paper.memory, 20000);
  EXPECT_EQ(paper.learning_rate, 0.001);
  EXPECT_EQ(paper.weight_decay, 0.001);
  EXPECT_EQ(paper.reward_loss, 0.01);
  EXPECT_EQ(paper.env_loss, 0.1);
  EXPECT_EQ(paper.task_loss, 0.001);
  EXPECT_EQ(paper.network.normalise_input, true);
  EXPECT_EQ(paper.network.normalise_embeddings, false);
  EXPECT_EQ(thrown([] { recipe("slow"); }), "64 unknown recipe 'slow', expected fast or paper");
}

TEST(Recipe, LearningRateSchedule) {
  ImitationOptions options = recipe("paper");
  EXPECT_EQ(options.rate(0, 100), 0.001);
  EXPECT_EQ(options.rate(1000000, 100), 0.001);
  options.warm_up = 10;
  options.cosine = 1;
  options.final_rate = 0.0001;
  EXPECT_DOUBLE_EQ(options.rate(0, 110), 0.0001);
  EXPECT_DOUBLE_EQ(options.rate(9, 110), 0.001);
  EXPECT_DOUBLE_EQ(options.rate(10, 110), 0.001);
  EXPECT_DOUBLE_EQ(options.rate(60, 110), 0.00055);
  EXPECT_DOUBLE_EQ(options.rate(110, 110), 0.0001);
  EXPECT_DOUBLE_EQ(options.rate(5000, 110), 0.0001);
}

TEST(Recipe, BalanceMovesToItsEnd) {
  ImitationOptions options;
  options.balance = 0.1;
  EXPECT_EQ(options.running_options(50, 101).balance, 0.1);
  options.balance_final = 0.3;
  options.warm_up = 10;
  for (const int update : {0, 5, 10})
    EXPECT_DOUBLE_EQ(options.running_options(update, 110).balance, 0.1);  // whatever the total
  EXPECT_DOUBLE_EQ(options.running_options(60, 110).balance, 0.2);
  EXPECT_DOUBLE_EQ(options.running_options(110, 110).balance, 0.3);
  EXPECT_DOUBLE_EQ(options.running_options(5000, 110).balance, 0.3);
}

TEST(Recipe, ComesBackThroughTheCheckpoint) {
  ImitationOptions options = recipe("fast");
  options.learning_rate = 0.1 + 0.2;
  const std::map<std::string, std::string> values = describe_options(options);
  EXPECT_EQ(describe_options(parse_options(values)), values);
  EXPECT_EQ(parse_options(values).learning_rate, 0.1 + 0.2);
  const auto refused = [&](const char* name, const char* value) {
    std::map<std::string, std::string> changed = values;
    changed[name] = value;
    return thrown([&] { parse_options(changed); });
  };
  EXPECT_EQ(refused("roll-in", "1.5"), "65 option 'roll-in': found '1.5', expected a number from 0 to 1");
  EXPECT_EQ(refused("memory", "0"), "65 option 'memory': found '0', expected a whole number from 1 to 1e+07");
  EXPECT_EQ(refused("memory", "2.5"), "65 option 'memory': found '2.5', expected a whole number from 1 to 1e+07");
  EXPECT_EQ(refused("lr", "nan"), "65 option 'lr': found 'nan', expected a number from 0 to 1");
  EXPECT_EQ(refused("sf-loss", "mse"), "65 option 'sf-loss': found 'mse', expected td, q or ce");
  std::map<std::string, std::string> missing = values;
  missing.erase("lr");
  EXPECT_EQ(thrown([&] { parse_options(missing); }), "65 the checkpoint has no option 'lr'");
}

TEST(Recipe, CheckpointsFromBeforeAnOptionHaveItsDefault) {
  std::map<std::string, std::string> values = describe_options(recipe("fast"));
  for (const char* name : {"action-embedding", "head-hidden", "seam", "dropout", "sf-loss", "discount"})
    ASSERT_EQ(values.erase(name), 1u) << name;
  EXPECT_EQ(describe_options(parse_options(values)), describe_options(recipe("fast")));
  values["seam"] = "0";
  EXPECT_EQ(thrown([&] { parse_options(values); }),
            "65 option 'seam': found '0', expected a whole number from 1 to 4096");
}

TEST(Shape, CheckpointsFromBeforeASizeHaveItsDefault) {
  PolicyShape shape;
  shape.seam = 7;
  shape.sf_loss = SfLoss::kCrossEntropy;
  std::map<std::string, int64_t> sizes = describe_shape(shape);
  EXPECT_EQ(describe_shape(parse_shape(sizes)), sizes);
  for (const char* name : {"action_embedding", "head_hidden", "seam", "sf_loss"})
    ASSERT_EQ(sizes.erase(name), 1u) << name;
  EXPECT_EQ(describe_shape(parse_shape(sizes)), describe_shape(PolicyShape()));
  sizes["seam"] = 0;
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 shape 'seam': found 0, expected a whole number from 1 to 65536");
  sizes.erase("seam");
  sizes["sf_loss"] = 3;
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 shape 'sf_loss': found 3, expected a whole number from 0 to 2");
  sizes = describe_shape(shape);
  sizes.erase("basis");
  EXPECT_EQ(thrown([&] { parse_shape(sizes); }), "65 the shape has no 'basis'");
}

TEST(Recipe, SomeValuesAreTheMethods) {
  for (const char* name : {"fast", "paper"}) {
    const ImitationOptions synpo = recipe(name);
    EXPECT_EQ(recipe(name, "mlp").network.feature, 256);
    EXPECT_EQ(recipe(name, "modulenet").network.head_hidden, 128);
    EXPECT_EQ(recipe(name, "sf").network.head_hidden, 512);
    EXPECT_EQ(describe_options(recipe(name, "mtl")), describe_options(synpo));
    EXPECT_EQ(synpo.reward_loss, 0.01);
  }
}

TEST(Recipe, FastHasWhatTheGridChoseForAMethodAndPaperHasNot) {
  EXPECT_EQ(recipe("paper", "sf").reward_loss, 1);
  EXPECT_EQ(recipe("paper", "sf").network.sf_loss, SfLoss::kTemporalDifference);
  EXPECT_EQ(recipe("fast", "sf").reward_loss, 0.01);
  EXPECT_EQ(recipe("fast", "sf").network.sf_loss, SfLoss::kCrossEntropy);
  EXPECT_EQ(recipe("fast", "modulenet").dropout, 0);
  EXPECT_EQ(recipe("fast", "mlp").embedding_sd, 0.3);
  for (const char* method : {"mlp", "modulenet", "sf"}) {
    EXPECT_EQ(recipe("paper", method).weight_decay, 0.001) << method;
    EXPECT_LT(recipe("fast", method).weight_decay, 0.001) << method;
  }
}

ImitationOptions from_command_line(std::vector<std::string> arguments, const std::string& method = "synpo") {
  RecipeOptions recipe_options;
  Options options("tool", "", "");
  recipe_options.add_to(options);
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  options.parse(int(argv.size()) - 1, argv.data());
  EXPECT_EQ(recipe_options.given(), arguments.size() > 1);
  return recipe_options.result(method);
}

TEST(Recipe, FromTheCommandLine) {
  EXPECT_EQ(describe_options(from_command_line({})), describe_options(recipe(kDefaultRecipe)));
  // The order of --recipe and what changes it does not matter.
  for (const auto& arguments : {std::vector<std::string>{"--recipe", "paper", "--task-loss", "0.5"},
                                {"--task-loss", "0.5", "--recipe", "paper"}}) {
    ImitationOptions want = recipe("paper");
    want.task_loss = 0.5;
    EXPECT_EQ(describe_options(from_command_line(arguments)), describe_options(want));
  }
  ImitationOptions want = recipe("fast", "sf");
  want.env_loss = want.task_loss = want.reward_loss = 0;
  want.network.sf_loss = SfLoss::kPlannerQ;
  EXPECT_EQ(describe_options(
                from_command_line({"--no-env-loss", "--no-task-loss", "--no-reward-loss", "--sf-loss", "q"}, "sf")),
            describe_options(want));
  EXPECT_EQ(thrown([] { from_command_line({"--sf-loss", "ce"}, "mlp"); }), "64 -m mlp has no --sf-loss");
  EXPECT_EQ(thrown([] { from_command_line({"--dropout", "0.1"}); }), "64 -m synpo has no --dropout");
  EXPECT_EQ(from_command_line({"--action-embedding", "3"}, "mtl").network.action_embedding, 3);
  EXPECT_EQ(thrown([] {
              from_command_line({"--sf-loss", "0"});
            }),
            "64 option --sf-loss: found '0', expected td, q or ce; try 'tool --help'");
  EXPECT_EQ(thrown([] {
              from_command_line({"--recipe", "paper", "--roll-in", "0.5"});
            }),
            "64 --roll-in needs --batch-states");
  EXPECT_EQ(thrown([] {
              from_command_line({"--recipe", "slow"});
            }),
            "64 option --recipe: found 'slow', expected fast or paper; try 'tool --help'");
  EXPECT_EQ(thrown([] {
              from_command_line({"--balance", "0"});
            }),
            "64 option --balance: found '0', expected a number from 0.001 to 1; try 'tool --help'");
}

}  // namespace
}  // namespace synpo
