#include "world/grid/planner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "world/grid/grid_set.h"

namespace synpo {
namespace {

const Task kRedBlue = {0, 1};

// Distances to `goal` by relaxing until nothing changes.
std::vector<int> distances_to(const Maze& maze, int goal) {
  constexpr int kFar = 100000;
  std::vector<int> distance(kGridCells, kFar);
  distance[goal] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const int at : maze.free_cells)
      for (const int next : {at - kGridSide, at + kGridSide, at - 1, at + 1})
        if (distance[next] + 1 < distance[at]) {
          distance[at] = distance[next] + 1;
          changed = true;
        }
  }
  return distance;
}

TEST(Planner, WalksShortestPathsAndBreaksTiesInOrder) {
  const GridSet world = GridSet::open("gridworld");
  static constexpr int offsets[4] = {-kGridSide, kGridSide, -1, 1};
  for (int env = 0; env < world.envs(); ++env) {
    const Maze& maze = world.maze(env);
    for (const uint8_t goal : maze.free_cells) {
      const std::vector<int> distance = distances_to(maze, goal);
      for (const uint8_t from : maze.free_cells) {
        ASSERT_EQ(world.planner(env).distance(from, goal), distance[from]);
        GridState state;
        state.now.agent = from;
        state.now.treasures = {goal, kPicked, kPicked, kPicked, kPicked};
        int first = kPick;
        for (int move = 3; move >= 0; --move)
          if (distance[from + offsets[move]] + 1 == distance[from]) first = move;
        ASSERT_EQ(world.planner(env).action(kRedBlue, state), first);
      }
    }
  }
}

TEST(Planner, ActsByItsValues) {
  const GridSet world = GridSet::open("gridworld");
  for (int i = 0; i < 4000; ++i) {
    const int env = i % world.envs(), task_number = i / 7 % world.task_count();
    const Task& task = world.tasks()[task_number];
    Random random(3, Purpose::kEpisodeStart, 0, uint64_t(i));
    GridState state = grid_reset(world.maze(env), random);
    if (i % 3 == 0) {
      state.now.treasures[task.first] = kPicked;
      state.picked = 1;
    }
    const Planner& planner = world.planner(env);
    const std::array<int, kGridActions> q = planner.q_cents(task, state);
    ASSERT_EQ(planner.action(task, state), std::max_element(q.begin(), q.end()) - q.begin());
    // Each value is the return of that action and the planner's own play after it.
    for (int action = 0; action < kGridActions; ++action) {
      GridState at = state;
      WorldStep step = grid_step(world.maze(env), task, at, action);
      int sum = step.reward_cents, steps = 0;
      while (!step.ended()) {
        ++steps;
        step = grid_step(world.maze(env), task, at, planner.action(task, at));
        sum += step.reward_cents;
      }
      ASSERT_EQ(q[action], sum) << "action " << action;
      if (action == planner.action(task, state)) {
        ASSERT_EQ(steps + 1, planner.steps_to_success(task, state));
      }
    }
  }
}

// The best return in hundredths from every (cell, picked), by value iteration over the world itself.
std::vector<int> best_returns(const Maze& maze, const Task& task, const std::array<uint8_t, kTreasures>& treasures) {
  std::vector<int> value(2 * kGridCells, -100000);
  for (bool changed = true; changed;) {
    changed = false;
    for (int picked = 0; picked < 2; ++picked)
      for (const uint8_t at : maze.free_cells)
        for (int action = 0; action < kGridActions; ++action) {
          GridState state;
          state.now = {at, treasures};
          state.picked = uint8_t(picked);
          if (picked) state.now.treasures[task.first] = kPicked;
          const WorldStep step = grid_step(maze, task, state, action);
          const int sum =
              step.reward_cents + (step.terminated ? 0 : value[state.picked * kGridCells + state.now.agent]);
          int& best = value[picked * kGridCells + at];
          if (sum > best) {
            best = sum;
            changed = true;
          }
        }
  }
  return value;
}

TEST(Planner, NothingBeatsIt) {
  const GridSet world = GridSet::open("gridworld");
  for (int i = 0; i < 40; ++i) {
    const int env = i % world.envs();
    const Task& task = world.tasks()[i * 3 % world.task_count()];
    Random random(4, Purpose::kEpisodeStart, 0, uint64_t(i));
    GridState state = grid_reset(world.maze(env), random);
    const std::vector<int> best = best_returns(world.maze(env), task, state.now.treasures);
    for (int picked = 0; picked < 2; ++picked) {
      state.picked = uint8_t(picked);
      if (picked) state.now.treasures[task.first] = kPicked;
      for (const uint8_t at : world.maze(env).free_cells) {
        state.now.agent = at;
        const std::array<int, kGridActions> q = world.planner(env).q_cents(task, state);
        ASSERT_EQ(*std::max_element(q.begin(), q.end()), best[picked * kGridCells + at]);
      }
    }
  }
}

TEST(Planner, MeanExpertEpisodeIs34To40Steps) {
  const GridSet world = GridSet::open("gridworld");
  double steps = 0;
  int episodes = 0;
  for (int env = 0; env < world.envs(); ++env)
    for (int task = 0; task < world.task_count(); ++task)
      for (uint64_t i = 0; i < 100; ++i, ++episodes) {
        Random random(1, Purpose::kEpisodeStart, world.pair_number({env, task}), i);
        steps += world.planner(env).steps_to_success(world.tasks()[task], grid_reset(world.maze(env), random));
      }
  EXPECT_GE(steps / episodes, 34);
  EXPECT_LE(steps / episodes, 40);
}

}  // namespace
}  // namespace synpo
