#include "learn/steps.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace synpo {
namespace {

constexpr int kUnit = 32;  // samples of a shard
constexpr size_t kPicture = size_t(kGridCells) * kHistory;
constexpr uint64_t kRestartStream = uint64_t{1} << 32;  // keeps restarts and updates apart among the numbers of Purpose::kRollIn

void put_planner_q(const GridSet& world, EnvTask pair, const GridState& state, int at, Minibatch& batch) {
  if (!batch.needs.planner_q) return;
  const std::array<int, kGridActions> cents = world.planner(pair.env).q_cents(world.tasks()[pair.task], state);
  for (int a = 0; a < kGridActions; ++a) batch.planner_q[size_t(at) * kGridActions + a] = float(cents[a]) / 100;
}

}  // namespace

StepKind step_kind(const GridState& state, int label) {
  if (state.steps == 0) return StepKind::kStart;
  if (label == kPick) return StepKind::kPick;
  return treasure_under_agent(state.now) >= 0 ? StepKind::kWalkOn : StepKind::kMove;
}

void Minibatch::resize(int size) {
  pictures.resize(size * kPicture);
  env.resize(size);
  task.resize(size);
  label.resize(size);
  taken.resize(size);
  reward.resize(size);
  kind.resize(size);
  next.assign(needs.next ? size : 0, StepBatch<float>::kUnknown);
  planner_q.resize(needs.planner_q ? size_t(size) * kGridActions : 0);
}

void TrajectoryDraw::draw(const GridSet& world, const ReplayMemory& memory, Parallel& parallel, int count, int window, uint64_t seed,
                          int64_t update, Minibatch& batch) {
  Random random(seed, Purpose::kBatch, 0, uint64_t(update));
  std::vector<const GridEpisode*> episodes(count);
  std::vector<int> first(count + 1, 0);
  for (int i = 0; i < count; ++i) {
    episodes[i] = &memory[random.below(uint32_t(memory.size()))];
    first[i + 1] = first[i] + int(episodes[i]->actions.size());
  }
  batch.resize(first[count]);
  parallel.run(count, [&](int i, int) {
    const GridEpisode& episode = *episodes[i];
    const Maze& maze = world.maze(episode.pair.env);
    const Task& task = world.tasks()[episode.pair.task];
    GridState state = episode.start;
    GridHistory history;
    for (size_t t = 0; t < episode.actions.size(); ++t) {
      const size_t at = first[i] + t;
      history.push(state.now);
      draw_history(maze, history, window, batch.pictures.data() + at * kPicture);
      batch.env[at] = episode.pair.env;
      batch.task[at] = episode.pair.task;
      batch.label[at] = episode.labels[t];
      batch.taken[at] = episode.actions[t];
      batch.kind[at] = step_kind(state, episode.labels[t]);
      put_planner_q(world, episode.pair, state, int(at), batch);
      const GridStep step = grid_step(maze, task, state, episode.actions[t]);
      batch.reward[at] = float(step.reward_cents) / 100;
      if (!batch.needs.next) continue;
      if (step.terminated)
        batch.next[at] = StepBatch<float>::kTerminal;
      else if (t + 1 < episode.actions.size())
        batch.next[at] = int(at) + 1;
    }
  });
}

void RunningDraw::restart(const ReplayMemory& memory, Running& running, uint32_t number) {
  Random random(seed_, Purpose::kRollIn, number, kRestartStream + running.restarts);
  const uint32_t place = random.below(uint32_t(memory.size()));
  const GridEpisode& episode = memory[place];
  const uint32_t restarts = running.restarts + 1;
  running = {episode.pair, episode.start, {}, memory.serial(place), place, restarts, !options_.fresh_starts, running.started};
  if (options_.fresh_starts) running.state = grid_reset(world_->maze(episode.pair.env), random);
  running.history.push(running.state.now);
}

const GridEpisode* RunningDraw::followed(const ReplayMemory& memory, const Running& running) {
  if (!running.following || memory.serial(running.place) != running.serial) return nullptr;
  const GridEpisode& episode = memory[running.place];
  // A recorded trajectory may break off before its episode ends.
  return running.state.steps < episode.actions.size() ? &episode : nullptr;
}

void RunningDraw::label_and_move(const ReplayMemory& memory, const Running& running, int& label, int& move) const {
  if (const GridEpisode* episode = followed(memory, running)) {
    label = episode->labels[running.state.steps];
    move = episode->actions[running.state.steps];
  } else {
    label = move = world_->planner(running.pair.env).action(world_->tasks()[running.pair.task], running.state);
  }
}

GridStep RunningDraw::move_on(const ReplayMemory& memory, Running& running, int action) const {
  const GridEpisode* episode = followed(memory, running);
  running.following = episode && episode->actions[running.state.steps] == action;
  const GridStep step = grid_step(world_->maze(running.pair.env), world_->tasks()[running.pair.task], running.state, action);
  running.history.push(running.state.now);
  return step;
}

void RunningDraw::step(const ReplayMemory& memory, Running& running, uint32_t number, int action) {
  if (move_on(memory, running, action).ended() || running.state.steps >= options_.step_limit) restart(memory, running, number);
}

// The step that takes `action` where the episode stands.
GridStep RunningDraw::put(const ReplayMemory& memory, const Running& running, int action, int window, int at, Minibatch& batch) const {
  Running after = running;
  const GridStep step = move_on(memory, after, action);
  int move;
  label_and_move(memory, running, batch.label[at], move);
  batch.env[at] = running.pair.env;
  batch.task[at] = running.pair.task;
  batch.taken[at] = action;
  batch.reward[at] = float(step.reward_cents) / 100;
  batch.kind[at] = step_kind(running.state, batch.label[at]);
  put_planner_q(*world_, running.pair, running.state, at, batch);
  draw_history(world_->maze(running.pair.env), running.history, window, batch.pictures.data() + size_t(at) * kPicture);
  return step;
}

void RunningDraw::draw(const ReplayMemory& memory, Parallel& parallel, int count, int window, int64_t update, Minibatch& batch) {
  if (batch.needs.next) count = (count + 1) / 2;
  // Never fewer than a minibatch takes: an episode is drawn once.
  if (running_.size() < size_t(count)) running_.resize(std::max(options_.episodes, count), Running{});
  batch.resize(batch.needs.next ? 2 * count : count);
  drawn_.resize(count);
  moves_.resize(count);
  for (int i = 0; i < count; ++i) {
    drawn_[i] = uint32_t(next_);
    next_ = (next_ + 1) % running_.size();
  }
  parallel.run(shard_count(count, kUnit), [&](int shard, int) {
    const Range range = shard_range(count, kUnit, shard);
    for (int i = range.begin; i < range.end; ++i) {
      const uint32_t number = drawn_[i];
      Running& running = running_[number];
      Random random(seed_, Purpose::kRollIn, number, uint64_t(update));
      int label, move;
      if (!running.started) {
        // Episodes that all began together would stay together: each goes some way with the expert first.
        running.started = true;
        restart(memory, running, number);
        for (uint32_t skip = random.below(40); skip > 0; --skip) {
          label_and_move(memory, running, label, move);
          step(memory, running, number, move);
        }
      }
      while (true) {
        label_and_move(memory, running, label, move);
        if (options_.noise > 0 && random.uniform() < options_.noise) move = int(random.below(kPick));
        if (treasure_under_agent(running.state.now) >= 0 || random.uniform() < options_.balance) break;
        step(memory, running, number, move);
      }
      moves_[i] = move;
      const GridStep step = put(memory, running, move, window, i, batch);
      if (!batch.needs.next) continue;
      // A last step stands twice, the second time with none behind it.
      const int behind = count + i;
      batch.next[i] = step.terminated ? StepBatch<float>::kTerminal : behind;
      Running after = running;
      if (!step.terminated) move_on(memory, after, move);
      label_and_move(memory, after, label, move);
      put(memory, after, move, window, behind, batch);
    }
  });
}

void RunningDraw::advance(const ReplayMemory& memory, const std::vector<int>& greedy, int64_t update) {
  for (size_t i = 0; i < drawn_.size(); ++i) {
    const uint32_t number = drawn_[i];
    Random random(seed_, Purpose::kOwnMove, number, uint64_t(update));
    const bool own = options_.roll_in > 0 && random.uniform() < options_.roll_in;
    step(memory, running_[number], number, own ? greedy[i] : moves_[i]);
  }
}

void RunningDraw::save(SafeTensors& file, const std::string& prefix) const {
  static_assert(std::is_trivially_copyable_v<Running>);
  // Field by field, so that padding never reaches the file.
  std::vector<int64_t> words;
  for (const Running& r : running_) {
    words.insert(words.end(), {r.pair.env, r.pair.task, r.state.picked, r.state.steps, int64_t(r.serial), r.place, r.restarts, r.following,
                               r.started, r.history.count});
    const auto add_frame = [&](const GridFrame& frame) {
      words.push_back(frame.agent);
      for (const uint8_t cell : frame.treasures) words.push_back(cell);
    };
    add_frame(r.state.now);
    for (const GridFrame& frame : r.history.frames) add_frame(frame);
  }
  file.add(prefix + "running", {int64_t(words.size())}, words.data(), words.size());
  const int64_t next = int64_t(next_);
  file.add(prefix + "next", {1}, &next, 1);
}

void RunningDraw::load(const SafeTensors& file, const std::string& prefix, const ReplayMemory& memory) {
  constexpr size_t kWords = 10 + (1 + kHistory) * (1 + kTreasures);
  const std::vector<int64_t> words = file.get<int64_t>(prefix + "running");
  int64_t next = 0;
  file.get(prefix + "next", &next, 1);
  const auto bad = [&] { fail(Exit::kData, "tensor '", prefix, "running' is malformed"); };
  if (words.size() % kWords != 0 || (!words.empty() && words.size() / kWords < size_t(options_.episodes))) bad();
  running_.assign(words.size() / kWords, Running{});
  if (next < 0 || (next > 0 && size_t(next) >= running_.size())) bad();
  next_ = size_t(next);
  const int64_t* at = words.data();
  const auto take = [&](int64_t low, int64_t high) {
    if (*at < low || *at > high) bad();
    return *at++;
  };
  for (Running& r : running_) {
    r.pair.env = int(take(0, world_->envs() - 1));
    r.pair.task = int(take(0, world_->task_count() - 1));
    r.state.picked = uint8_t(take(0, 1));
    r.state.steps = uint16_t(take(0, kGridStepLimit - 1));
    r.serial = uint64_t(take(0, INT64_MAX));
    r.place = uint32_t(take(0, UINT32_MAX));
    r.restarts = uint32_t(take(0, UINT32_MAX));
    r.following = take(0, 1) != 0;
    r.started = take(0, 1) != 0;
    r.history.count = uint8_t(take(0, kHistory));
    const auto take_frame = [&](GridFrame& frame) {
      frame.agent = uint8_t(take(0, 255));
      for (uint8_t& cell : frame.treasures) cell = uint8_t(take(0, 255));
    };
    take_frame(r.state.now);
    for (GridFrame& frame : r.history.frames) take_frame(frame);
    if (!r.started) continue;
    if (r.place >= memory.size() || world_->maze(r.pair.env).wall[r.state.now.agent]) bad();
    if (r.following && memory.serial(r.place) == r.serial && r.state.steps >= memory[r.place].actions.size()) bad();
  }
}

}  // namespace synpo
