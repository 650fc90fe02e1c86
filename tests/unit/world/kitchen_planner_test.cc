#include "world/kitchen/planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <thread>

#include "base/error.h"
#include "helpers/kitchens.h"
#include "world/kitchen/kitchen_set.h"

namespace synpo {
namespace {

TEST(KitchenPlanner, EveryTaskCanBeDoneFromEverywhere) {
  for (int env = 0; env < all_kitchens().envs(); ++env)
    for (int task = 0; task < kKitchenTasks; ++task) {
      Random random(5, Purpose::kEpisodeStart, uint64_t(env), uint64_t(task));
      KitchenState state = unpack(all_kitchens().reset(env, random));
      for (int pose = 0; pose < all_kitchens().tables(env).pose_count(); ++pose)
        for (int doors = 0; doors < kDoorStates; ++doors) {
          state.pose = uint16_t(pose);
          state.doors = uint8_t(doors);
          const int steps =
              all_kitchens().planner(env).steps_to_success(kitchen_task(task), state);  // throws where it cannot
          ASSERT_GE(steps, 2);
          ASSERT_LT(steps, 100);
        }
    }
}

TEST(KitchenPlanner, ItsEpisodesSucceed) {
  int opened = 0;
  for (int i = 0; i < 1200; ++i) {
    const EnvTask pair = {i % all_kitchens().envs(), i / 3 % all_kitchens().task_count()};
    Random random(6, Purpose::kEpisodeStart, 0, uint64_t(i));
    WorldState state = all_kitchens().reset(pair.env, random);
    const int plan = all_kitchens().planner(pair.env).steps_to_success(kitchen_task(pair.task), unpack(state));
    int cents = 0, steps = 0;
    WorldStep step = {};
    while (!step.ended()) {
      ASSERT_TRUE(all_kitchens().valid(pair, state));
      const int action = all_kitchens().expert(pair, state);
      opened += action == kOpenClose;
      if (action == kPickupPut) {
        ASSERT_TRUE(all_kitchens().at_choice(pair, state));
      }
      step = all_kitchens().step(pair, state, action);
      cents += step.reward_cents;
      ++steps;
    }
    ASSERT_TRUE(step.success);
    ASSERT_EQ(steps, plan);
    ASSERT_EQ(cents, 1100 - steps);
  }
  EXPECT_GT(opened, 600);
}

TEST(KitchenPlanner, ActsByItsValues) {
  for (int i = 0; i < 600; ++i) {
    const EnvTask pair = {i % all_kitchens().envs(), i / 5 % all_kitchens().task_count()};
    Random random(7, Purpose::kEpisodeStart, 0, uint64_t(i)), moves(7, Purpose::kNoise, 0, uint64_t(i));
    WorldState state = all_kitchens().reset(pair.env, random);
    for (uint32_t wander = moves.below(40); wander > 0; --wander) {
      WorldState next = state;
      if (!all_kitchens().step(pair, next, int(moves.below(kKitchenActions))).ended()) state = next;
    }
    int q[kKitchenActions];
    all_kitchens().action_values(pair, state, q);
    ASSERT_EQ(all_kitchens().expert(pair, state), std::max_element(q, q + kKitchenActions) - q);
    for (int action = 0; action < kKitchenActions; ++action) {
      WorldState at = state;
      at.steps = 0;
      WorldStep step = all_kitchens().step(pair, at, action);
      int sum = step.reward_cents;
      while (!step.ended()) {
        step = all_kitchens().step(pair, at, all_kitchens().expert(pair, at));
        sum += step.reward_cents;
      }
      ASSERT_EQ(q[action], sum) << kKitchenActionNames[action];
    }
  }
}

// The best return from every state that can be reached from `start`, by value iteration over the world itself.
std::map<decltype(WorldState::bytes), int> best_returns(const World& small, EnvTask pair, const WorldState& start) {
  struct Edge {
    int cents, to;  // -1 where the episode ends
  };
  std::map<decltype(WorldState::bytes), int> index = {{start.bytes, 0}};
  std::vector<WorldState> states = {start};
  std::vector<std::array<Edge, kKitchenActions>> edges;
  for (size_t i = 0; i < states.size(); ++i) {
    std::array<Edge, kKitchenActions> out;
    for (int action = 0; action < kKitchenActions; ++action) {
      WorldState next = states[i];
      const WorldStep step = small.step(pair, next, action);
      next.steps = 0;
      out[size_t(action)] = {step.reward_cents, -1};
      if (step.ended()) continue;
      const auto [found, is_new] = index.emplace(next.bytes, int(states.size()));
      if (is_new) states.push_back(next);
      out[size_t(action)].to = found->second;
    }
    edges.push_back(out);
  }
  std::vector<int> value(states.size(), -100000);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < states.size(); ++i)
      for (const Edge& edge : edges[i]) {
        const int sum = edge.cents + (edge.to < 0 ? 0 : value[size_t(edge.to)]);
        if (sum > value[i]) {
          value[i] = sum;
          changed = true;
        }
      }
  }
  for (auto& [bytes, number] : index) number = value[size_t(number)];
  return index;
}

TEST(KitchenPlanner, NothingBeatsIt) {
  const KitchenSet small({small_kitchen()});
  for (int task = 0; task < kKitchenTasks; task += 2) {
    Random random(8, Purpose::kEpisodeStart, 0, uint64_t(task));
    const WorldState start = small.reset(0, random);
    const auto best = best_returns(small, {0, task}, start);
    EXPECT_GT(best.size(), small.tables(0).poses.size() * 6);
    for (const auto& [bytes, value] : best) {
      WorldState state;
      state.bytes = bytes;
      int q[kKitchenActions];
      small.action_values({0, task}, state, q);
      ASSERT_EQ(*std::max_element(q, q + kKitchenActions), value);
    }
  }
}

// Tables in which a door hides what is behind it: the planner must take each door's own lists.
TEST(KitchenPlanner, SeesByTheDoors) {
  KitchenTables tables = ring_tables();
  auto open = std::make_shared<KitchenSight>(*tables.sight[0]);
  open->slots = seen_lists({{{100, 0}}, {}, {}, {}, {}});
  tables.sight[1] = tables.sight[3] = open;
  const KitchenPlanner planner("ring", tables);
  KitchenState state;
  state.slots = {4, 5, 0, 9, 6, 7, 8};
  // Closed: turn to pose 1 and take the Mug, on to 2, then 3, open, put. Open: take it at once, turn left twice, put.
  EXPECT_EQ(planner.steps_to_success({2, kFridge}, state), 6);
  state.doors = 1;
  EXPECT_EQ(planner.steps_to_success({2, kFridge}, state), 4);
  EXPECT_EQ(planner.action({2, kFridge}, state), kPickupPut);
}

TEST(KitchenPlanner, RefusesWhatCannotBeUsed) {
  KitchenTables tables = ring_tables();
  auto sight = std::make_shared<KitchenSight>(*tables.sight[0]);
  sight->receptacles = seen_lists({{}, {}, {{500, kSink}, {700, kFridge}}, {}, {{100, kMicrowave}}});
  tables.sight.fill(sight);
  try {
    const KitchenPlanner planner("ring", tables);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::kData);
    EXPECT_STREQ(error.what(), "ring: the Fridge cannot be used from row 1, column 0, heading 0, horizon 0");
  }
}

// More tables than are kept, for several tasks from every start, asked for in different orders by four threads.
TEST(KitchenPlanner, GivesTheSameWithAndWithoutItsMemory) {
  constexpr int kStarts = 150;
  std::vector<int> expected;
  for (int i = 0; i < kStarts; ++i) {
    const KitchenSet fresh({small_kitchen()});
    Random random(9, Purpose::kEpisodeStart, 0, uint64_t(i / 3));
    expected.push_back(
        fresh.planner(0).steps_to_success(kitchen_task(i % kKitchenTasks), unpack(fresh.reset(0, random))));
  }
  const KitchenSet shared({small_kitchen()});
  std::vector<std::vector<int>> found(4, std::vector<int>(kStarts));
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      for (int round = 0; round < 3; ++round)
        for (int n = 0; n < kStarts; ++n) {
          const int i = n * (thread * 6 + 1) % kStarts;
          Random random(9, Purpose::kEpisodeStart, 0, uint64_t(i / 3));
          found[size_t(thread)][size_t(i)] =
              shared.planner(0).steps_to_success(kitchen_task(i % kKitchenTasks), unpack(shared.reset(0, random)));
        }
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& steps : found) EXPECT_EQ(steps, expected);
}

}  // namespace
}  // namespace synpo
