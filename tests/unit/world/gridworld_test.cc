#include "world/grid/gridworld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "helpers/mazes.h"
#include "world/grid/grid_set.h"
#include "world/grid/view.h"

namespace synpo {
namespace {

// Treasures in a row at the bottom of an open maze.
GridState start_at(uint8_t agent) {
  GridState state;
  state.now = {agent, {cell(14, 1), cell(14, 2), cell(14, 3), cell(14, 4), cell(14, 5)}};
  return state;
}

const Task kRedBlue = {0, 1};

TEST(GridWorld, MovesUpDownLeftRight) {
  const Maze maze = open_maze();
  const std::pair<int, uint8_t> moves[] = {
      {kUp, cell(4, 5)}, {kDown, cell(6, 5)}, {kLeft, cell(5, 4)}, {kRight, cell(5, 6)}};
  for (const auto& [action, to] : moves) {
    GridState state = start_at(cell(5, 5));
    const WorldStep step = grid_step(maze, kRedBlue, state, action);
    EXPECT_EQ(state.now.agent, to);
    EXPECT_EQ(state.steps, 1);
    EXPECT_EQ(step.reward_cents, -1);
    EXPECT_FALSE(step.ended() || step.success || step.wrong);
  }
}

TEST(GridWorld, AWallCostsAnotherCentAndStays) {
  Maze maze = open_maze();
  for (const uint8_t wall : {cell(4, 5), cell(6, 5), cell(5, 4), cell(5, 6)}) maze.wall[wall] = true;
  for (const int action : {kUp, kDown, kLeft, kRight}) {
    GridState state = start_at(cell(5, 5));
    EXPECT_EQ(grid_step(maze, kRedBlue, state, action).reward_cents, -2);
    EXPECT_EQ(state.now.agent, cell(5, 5));
    EXPECT_EQ(state.steps, 1);
  }
}

TEST(GridWorld, PickOnAnEmptyCellDoesNothingMore) {
  GridState state = start_at(cell(5, 5));
  const GridState before = state;
  const WorldStep step = grid_step(open_maze(), kRedBlue, state, kPick);
  EXPECT_EQ(step.reward_cents, -1);
  EXPECT_FALSE(step.ended() || step.wrong);
  EXPECT_EQ(state.now, before.now);
  EXPECT_EQ(state.picked, 0);
  EXPECT_EQ(state.steps, 1);
}

TEST(GridWorld, PicksInOrder) {
  const Maze maze = open_maze();
  GridState state = start_at(cell(14, 1));
  const WorldStep first = grid_step(maze, kRedBlue, state, kPick);
  EXPECT_EQ(first.reward_cents, 99);
  EXPECT_FALSE(first.ended() || first.success || first.wrong);
  EXPECT_EQ(state.now.treasures[0], kPicked);
  EXPECT_EQ(state.picked, 1);
  // What was picked is gone: a second pick finds nothing.
  EXPECT_EQ(grid_step(maze, kRedBlue, state, kPick).reward_cents, -1);
  EXPECT_EQ(grid_step(maze, kRedBlue, state, kRight).reward_cents, -1);
  const WorldStep last = grid_step(maze, kRedBlue, state, kPick);
  EXPECT_EQ(last.reward_cents, 1099);
  EXPECT_TRUE(last.terminated && last.success);
  EXPECT_FALSE(last.truncated || last.wrong);
  EXPECT_EQ(state.picked, 2);
  EXPECT_EQ(state.steps, 4);
}

TEST(GridWorld, AnyOtherTreasureEndsTheEpisode) {
  const Maze maze = open_maze();
  for (int treasure = 1; treasure < kTreasures; ++treasure) {
    GridState state = start_at(cell(14, 1 + treasure));
    const WorldStep step = grid_step(maze, kRedBlue, state, kPick);
    EXPECT_EQ(step.reward_cents, -1001);
    EXPECT_TRUE(step.terminated && step.wrong);
    EXPECT_FALSE(step.truncated || step.success);
  }
  GridState state = start_at(cell(14, 3));
  state.picked = 1;
  state.now.treasures[0] = kPicked;
  EXPECT_EQ(grid_step(maze, kRedBlue, state, kPick).reward_cents, -1001);
}

TEST(GridWorld, IsCutAfter300Steps) {
  const Maze maze = open_maze();
  GridState state = start_at(cell(1, 1));
  for (int i = 1; i < kStepLimit; ++i) ASSERT_FALSE(grid_step(maze, kRedBlue, state, kUp).ended());
  GridState other = state;
  const WorldStep cut = grid_step(maze, kRedBlue, state, kUp);
  EXPECT_TRUE(cut.truncated);
  EXPECT_FALSE(cut.terminated || cut.success || cut.wrong);
  EXPECT_EQ(state.steps, 300);
  // An episode that ends by itself in its last step is not cut.
  other.now.agent = cell(14, 5);
  const WorldStep wrong = grid_step(maze, kRedBlue, other, kPick);
  EXPECT_TRUE(wrong.terminated);
  EXPECT_FALSE(wrong.truncated);
}

TEST(GridWorld, StartsAnywhereOnFreeCells) {
  const Maze& maze = builtin_mazes()[0];
  std::map<int, int> agents, red;
  int on_treasure = 0;
  constexpr int kStarts = 40000;
  for (int i = 0; i < kStarts; ++i) {
    Random random(1, Purpose::kEpisodeStart, 0, uint64_t(i));
    const GridState state = grid_reset(maze, random);
    EXPECT_EQ(state.picked + state.steps, 0);
    const std::set<uint8_t> distinct(state.now.treasures.begin(), state.now.treasures.end());
    ASSERT_EQ(distinct.size(), size_t(kTreasures));
    for (const uint8_t at : distinct) ASSERT_FALSE(maze.wall[at]);
    ASSERT_FALSE(maze.wall[state.now.agent]);
    ++agents[state.now.agent];
    ++red[state.now.treasures[0]];
    on_treasure += treasure_under_agent(state.now) >= 0;
  }
  const double cells = double(maze.free_cells.size());
  for (const auto* counts : {&agents, &red}) {
    double chi_square = 0;
    for (const uint8_t at : maze.free_cells) {
      const double found = counts->count(at) ? counts->at(at) : 0, expected = kStarts / cells;
      chi_square += (found - expected) * (found - expected) / expected;
    }
    EXPECT_LT(chi_square, cells + 5 * std::sqrt(2 * cells));
  }
  EXPECT_NEAR(on_treasure, kStarts * kTreasures / cells, 5 * std::sqrt(kStarts * kTreasures / cells));
}

TEST(GridWorld, TasksStandInTheOrderOfFigure6) {
  std::string names;
  for (const Task& task : grid_tasks()) names += task.name() + " ";
  EXPECT_EQ(names, "R-B B-G G-O O-P P-R R-G B-O G-P O-R P-B R-O B-P G-R O-B P-G R-P B-R G-B O-G P-O ");
}

TEST(GridWorld, TwoEqualWorldsStepAlike) {
  const GridSet a = GridSet::open("gridworld"), b = GridSet::open("gridworld");
  ASSERT_EQ(a.envs(), b.envs());
  for (int episode = 0; episode < 60; ++episode) {
    const int env = episode % a.envs(), task = episode * 7 % a.task_count();
    Random start_a(9, Purpose::kEpisodeStart, 1, uint64_t(episode)),
        start_b(9, Purpose::kEpisodeStart, 1, uint64_t(episode));
    Random moves(9, Purpose::kNoise, 1, uint64_t(episode));
    GridState state_a = grid_reset(a.maze(env), start_a), state_b = grid_reset(b.maze(env), start_b);
    WorldStep step_a = {}, step_b = {};
    while (!step_a.ended()) {
      ASSERT_EQ(state_a, state_b);
      uint8_t view_a[kGridCells], view_b[kGridCells];
      draw_view(a.maze(env), state_a.now, 1, view_a);
      draw_view(b.maze(env), state_b.now, 1, view_b);
      ASSERT_TRUE(std::equal(view_a, view_a + kGridCells, view_b));
      ASSERT_EQ(a.planner(env).q_cents(a.tasks()[task], state_a), b.planner(env).q_cents(b.tasks()[task], state_b));
      const int action = int(moves.below(kGridActions));
      step_a = grid_step(a.maze(env), a.tasks()[task], state_a, action);
      step_b = grid_step(b.maze(env), b.tasks()[task], state_b, action);
      ASSERT_EQ(step_a.reward_cents, step_b.reward_cents);
      ASSERT_EQ(step_a.terminated, step_b.terminated);
      ASSERT_EQ(step_a.truncated, step_b.truncated);
    }
  }
}

}  // namespace
}  // namespace synpo
