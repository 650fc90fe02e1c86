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

// One cell's colour by the rules, from the top layer down.
int colour_of(const Maze& maze, const GridFrame& frame, int radius, int at) {
  if (at == frame.agent) return kAgent;
  for (int i = 0; i < kTreasures; ++i)
    if (frame.treasures[i] != kPicked && frame.treasures[i] == at) return kFirstTreasure + i;
  const int rows = std::abs(at / kGridSide - frame.agent / kGridSide),
            columns = std::abs(at % kGridSide - frame.agent % kGridSide);
  if (rows > radius || columns > radius) return kUnseen;
  return maze.wall[at] ? kWall : kFloor;
}

TEST(View, FollowsTheRules) {
  const std::vector<Maze>& mazes = builtin_mazes();
  for (int i = 0; i < 2000; ++i) {
    const Maze& maze = mazes[i % mazes.size()];
    Random random(5, Purpose::kEpisodeStart, 0, uint64_t(i));
    GridState state = grid_reset(maze, random);
    if (i % 2) state.now.treasures[1 + i % 4] = kPicked;
    if (i % 5 == 0) state.now.agent = state.now.treasures[0];
    for (const int radius : {0, 1, 2, 16}) {
      uint8_t view[kGridCells];
      draw_view(maze, state.now, radius, view);
      for (int at = 0; at < kGridCells; ++at)
        ASSERT_EQ(int(view[at]), colour_of(maze, state.now, radius, at)) << "radius " << radius;
    }
  }
}

// The picture as text: ' ' unseen, '.' floor, '#' wall, '@' agent, letters for treasures.
std::string shown(const uint8_t* view, int rows) {
  std::string text;
  for (int at = 0; at < rows * kGridSide; ++at) {
    text += (std::string(" .#@") + kTreasureLetters)[view[at]];
    if (at % kGridSide == kGridSide - 1) text += '\n';
  }
  return text;
}

TEST(View, OnePictureByHand) {
  GridFrame frame = {cell(1, 1), {cell(1, 2), cell(1, 1), cell(2, 14), kPicked, cell(3, 7)}};
  uint8_t view[kGridCells];
  draw_view(open_maze(), frame, 1, view);
  EXPECT_EQ(shown(view, 4),
            "###             \n"
            "#@R             \n"
            "#..           G \n"
            "       P        \n");
  draw_view(open_maze(), frame, 0, view);
  EXPECT_EQ(shown(view, 4),
            "                \n"
            " @R             \n"
            "              G \n"
            "       P        \n");
}

TEST(View, ColoursDiffer) {
  std::set<int> colours;
  for (const Rgb& rgb : kPalette) colours.insert(rgb.r << 16 | rgb.g << 8 | rgb.b);
  EXPECT_EQ(colours.size(), size_t(kGridColours));
  EXPECT_EQ(kPalette[kUnseen].r + kPalette[kUnseen].g + kPalette[kUnseen].b, 0);
}

TEST(History, NewestIsLastAndMissingOnesAreUnseen) {
  const Maze maze = open_maze();
  StateHistory history;
  std::vector<GridFrame> frames;
  for (int step = 0; step < 7; ++step) {
    const GridState state = start_at(cell(2, 2 + step));
    frames.push_back(state.now);
    history.push(to_world_state(state));
    std::vector<uint8_t> pictures(kGridCells * kHistory, 99);
    draw_history(maze, history, 1, pictures.data());
    for (int f = 0; f < kHistory; ++f) {
      const int frame = step - (kHistory - 1) + f;
      for (int at = 0; at < kGridCells; ++at)
        ASSERT_EQ(int(pictures[at * kHistory + f]), frame < 0 ? int(kUnseen) : colour_of(maze, frames[frame], 1, at))
            << step;
    }
  }
}

}  // namespace
}  // namespace synpo
