#include "play/episode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "helpers/episodes.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"
#include "learn/recipe.h"
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

}  // namespace
}  // namespace synpo
