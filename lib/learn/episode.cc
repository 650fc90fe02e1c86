#include "learn/episode.h"

#include <cstdio>

#include "base/error.h"

namespace synpo {
namespace {

constexpr char kWorld[] = "gridworld";
constexpr char kAgent[] = "agent";

std::pair<int, int> place(int cell) { return {cell / kGridSide, cell % kGridSide}; }

// The free cell that `start` gives under `name`.
uint8_t start_cell(const Maze& maze, const Trajectory& t, const std::string& name) {
  const auto found = t.start.find(name);
  if (found == t.start.end()) fail(Exit::kData, "field 'start': no place for ", quoted(name));
  const auto [row, column] = found->second;
  if (row >= kGridSide || column >= kGridSide || maze.wall[row * kGridSide + column])
    fail(Exit::kData, "field 'start': ", quoted(name), " at row ", row, ", column ", column, " is not on the floor of ", maze.name);
  return uint8_t(row * kGridSide + column);
}

std::string money(int cents) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", cents / 100.0);
  return text;
}

}  // namespace

GridState episode_start(const GridSet& world, EnvTask pair, uint64_t seed, Purpose purpose, int64_t episode) {
  Random random(seed, purpose, world.pair_number(pair.env, pair.task), uint64_t(episode));
  return grid_reset(world.maze(pair.env), random);
}

Trajectory to_trajectory(const GridSet& world, const GridEpisode& episode, const std::vector<int>& reward_cents, const GridStep& last,
                         uint64_t seed, int64_t number, int window) {
  const Maze& maze = world.maze(episode.pair.env);
  Trajectory t;
  t.world = kWorld;
  t.rules = kGridRules;
  t.env = maze.name;
  t.task = world.tasks()[episode.pair.task].name();
  t.env_hash = maze.hash;
  t.window = window;
  t.seed = seed;
  t.episode = number;
  t.start[kAgent] = place(episode.start.now.agent);
  for (int i = 0; i < kTreasures; ++i) t.start[std::string(1, kTreasureLetters[i])] = place(episode.start.now.treasures[i]);
  t.actions = episode.actions;
  if (episode.labels != episode.actions) t.labels = episode.labels;
  t.reward_cents = reward_cents;
  t.success = last.success;
  t.terminated = last.terminated;
  t.truncated = last.truncated;
  return t;
}

Trajectory expert_episode(const GridSet& world, EnvTask pair, uint64_t seed, int64_t episode, double noise, int window) {
  const Maze& maze = world.maze(pair.env);
  const Planner& planner = world.planner(pair.env);
  const Task& task = world.tasks()[pair.task];
  Random random(seed, Purpose::kNoise, world.pair_number(pair.env, pair.task), uint64_t(episode));
  GridEpisode played = {pair, episode_start(world, pair, seed, Purpose::kEpisodeStart, episode), {}, {}};
  std::vector<int> rewards;
  GridState state = played.start;
  GridStep step = {};
  while (!step.ended()) {
    const int label = planner.action(task, state);
    const int action = noise > 0 && random.uniform() < noise ? int(random.below(kPick)) : label;
    played.labels.push_back(uint8_t(label));
    played.actions.push_back(uint8_t(action));
    step = grid_step(maze, task, state, action);
    rewards.push_back(step.reward_cents);
  }
  return to_trajectory(world, played, rewards, step, seed, episode, window);
}

GridEpisode replay(const GridSet& world, const Trajectory& t) {
  if (t.world != kWorld) fail(Exit::kData, "world ", quoted(t.world), ", expected '", kWorld, "'");
  if (t.rules != kGridRules) fail(Exit::kData, "rules version ", t.rules, ", this build has ", kGridRules);
  const int env = world.env_index(t.env), task_index = world.task_index(t.task);
  if (env < 0) fail(Exit::kData, "unknown env ", quoted(t.env), " (other maps? see -w)");
  if (task_index < 0) fail(Exit::kData, "unknown task ", quoted(t.task));
  const Maze& maze = world.maze(env);
  if (t.env_hash != maze.hash) fail(Exit::kData, "env ", quoted(t.env), " is not the maze of that name here (other maps? see -w)");
  GridEpisode episode = {{env, task_index}, {}, t.actions, t.labels.empty() ? t.actions : t.labels};
  GridState& start = episode.start;
  start.now.agent = start_cell(maze, t, kAgent);
  for (int i = 0; i < kTreasures; ++i) {
    start.now.treasures[i] = start_cell(maze, t, std::string(1, kTreasureLetters[i]));
    for (int j = 0; j < i; ++j)
      if (start.now.treasures[i] == start.now.treasures[j]) fail(Exit::kData, "field 'start': two treasures on one cell");
  }
  const Task& task = world.tasks()[task_index];
  GridState state = start;
  for (size_t i = 0; i < t.actions.size(); ++i) {
    const GridStep step = grid_step(maze, task, state, t.actions[i]);
    if (step.reward_cents != t.reward_cents[i])
      fail(Exit::kData, "replay gives reward ", money(step.reward_cents), " at step ", i + 1, ", file says ", money(t.reward_cents[i]),
           ": other maps?");
    const bool last = i + 1 == t.actions.size();
    if (step.ended() && !last) fail(Exit::kData, "replay ends at step ", i + 1, ", file goes on to ", t.actions.size());
    if (last && (step.terminated != t.terminated || step.truncated != t.truncated || step.success != t.success))
      fail(Exit::kData, "replay and file differ in success, terminated or truncated");
  }
  return episode;
}

Trajectory relabelled(const GridSet& world, const Trajectory& trajectory) {
  const GridEpisode episode = replay(world, trajectory);
  const Task& task = world.tasks()[episode.pair.task];
  Trajectory out = trajectory;
  out.labels.clear();
  GridState state = episode.start;
  for (const uint8_t action : episode.actions) {
    out.labels.push_back(uint8_t(world.planner(episode.pair.env).action(task, state)));
    grid_step(world.maze(episode.pair.env), task, state, action);
  }
  if (out.labels == out.actions) out.labels.clear();
  return out;
}

std::vector<EnvTask> resolve_pairs(const GridSet& world, const std::vector<PairRow>& rows, bool seen_only) {
  std::vector<EnvTask> pairs;
  for (const PairRow& row : rows) {
    const EnvTask pair = {world.env_index(row.env), world.task_index(row.task)};
    if (pair.env < 0) fail(Exit::kData, "pairs: unknown env ", quoted(row.env), " (other maps?)");
    if (pair.task < 0) fail(Exit::kData, "pairs: unknown task ", quoted(row.task));
    if (row.seen || !seen_only) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace synpo
