#include "learn/steps.h"

#include <algorithm>

#include "base/error.h"

namespace synpo {
namespace {

constexpr int kUnit = 32;  // samples of a shard
constexpr uint64_t kRestartStream = uint64_t{1}
                                    << 32;  // keeps restarts and updates apart among the numbers of Purpose::kRollIn

void put_planner_q(const World& world, EnvTask pair, const WorldState& state, int at, Minibatch& batch) {
  if (!batch.needs.planner_q) return;
  const int actions = world.actions();
  std::vector<int> cents(actions);
  world.action_values(pair, state, cents.data());
  for (int a = 0; a < actions; ++a) batch.planner_q[size_t(at) * actions + a] = float(cents[a]) / 100;
}

}  // namespace

void Minibatch::resize(const World& world, int size) {
  observations.resize(size * world.observation_size());
  env.resize(size);
  task.resize(size);
  label.resize(size);
  taken.resize(size);
  reward.resize(size);
  kind.resize(size);
  next.assign(needs.next ? size : 0, StepBatch<float>::kUnknown);
  planner_q.resize(needs.planner_q ? size_t(size) * world.actions() : 0);
}

void TrajectoryDraw::draw(const World& world, const ReplayMemory& memory, Parallel& parallel, int count, int window,
                          uint64_t seed, int64_t update, Minibatch& batch) {
  Random random(seed, Purpose::kBatch, 0, uint64_t(update));
  std::vector<const Episode*> episodes(count);
  std::vector<int> first(count + 1, 0);
  for (int i = 0; i < count; ++i) {
    episodes[i] = &memory[random.below(uint32_t(memory.size()))];
    first[i + 1] = first[i] + int(episodes[i]->actions.size());
  }
  batch.resize(world, first[count]);
  parallel.run(count, [&](int i, int) {
    const Episode& episode = *episodes[i];
    RunningEpisode running;
    running.start(episode.pair, episode.start);
    for (size_t t = 0; t < episode.actions.size(); ++t) {
      const size_t at = first[i] + t;
      world.observe(episode.pair.env, running.history, window,
                    batch.observations.data() + at * world.observation_size());
      batch.env[at] = episode.pair.env;
      batch.task[at] = episode.pair.task;
      batch.label[at] = episode.labels[t];
      batch.taken[at] = episode.actions[t];
      batch.kind[at] = world.kind(episode.pair, running.now(), episode.labels[t]);
      put_planner_q(world, episode.pair, running.now(), int(at), batch);
      const WorldStep step = running.step(world, episode.actions[t]);
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
  const Episode& episode = memory[place];
  const uint32_t restarts = running.restarts + 1;
  running = {{}, memory.serial(place), place, restarts, !options_.fresh_starts, running.started};
  running.episode.start(episode.pair, options_.fresh_starts ? world_->reset(episode.pair.env, random) : episode.start);
}

const Episode* RunningDraw::followed(const ReplayMemory& memory, const Running& running) {
  if (!running.following || memory.serial(running.place) != running.serial) return nullptr;
  const Episode& episode = memory[running.place];
  // A recorded trajectory may break off before its episode ends.
  return running.episode.now().steps < episode.actions.size() ? &episode : nullptr;
}

void RunningDraw::label_and_move(const ReplayMemory& memory, const Running& running, int& label, int& move) const {
  if (const Episode* episode = followed(memory, running)) {
    label = episode->labels[running.episode.now().steps];
    move = episode->actions[running.episode.now().steps];
  } else {
    label = move = world_->expert(running.episode.pair, running.episode.now());
  }
}

WorldStep RunningDraw::move_on(const ReplayMemory& memory, Running& running, int action) const {
  const Episode* episode = followed(memory, running);
  running.following = episode && episode->actions[running.episode.now().steps] == action;
  return running.episode.step(*world_, action);
}

void RunningDraw::step(const ReplayMemory& memory, Running& running, uint32_t number, int action) {
  if (move_on(memory, running, action).ended() || running.episode.now().steps >= options_.step_limit)
    restart(memory, running, number);
}

// The step that takes `action` where the episode stands.
WorldStep RunningDraw::put(const ReplayMemory& memory, const Running& running, int action, int window, int at,
                           Minibatch& batch) const {
  Running after = running;
  const WorldStep step = move_on(memory, after, action);
  int move;
  label_and_move(memory, running, batch.label[at], move);
  const EnvTask pair = running.episode.pair;
  const WorldState& state = running.episode.now();
  batch.env[at] = pair.env;
  batch.task[at] = pair.task;
  batch.taken[at] = action;
  batch.reward[at] = float(step.reward_cents) / 100;
  batch.kind[at] = world_->kind(pair, state, batch.label[at]);
  put_planner_q(*world_, pair, state, at, batch);
  world_->observe(pair.env, running.episode.history, window,
                  batch.observations.data() + size_t(at) * world_->observation_size());
  return step;
}

void RunningDraw::draw(const ReplayMemory& memory, Parallel& parallel, int count, int window, int64_t update,
                       Minibatch& batch) {
  if (batch.needs.next) count = (count + 1) / 2;
  // Never fewer than a minibatch takes: an episode is drawn once.
  if (running_.size() < size_t(count)) running_.resize(std::max(options_.episodes, count), Running{});
  batch.resize(*world_, batch.needs.next ? 2 * count : count);
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
        if (options_.noise > 0 && random.uniform() < options_.noise)
          move = int(random.below(uint32_t(world_->moves())));
        if (world_->at_choice(running.episode.pair, running.episode.now()) || random.uniform() < options_.balance)
          break;
        step(memory, running, number, move);
      }
      moves_[i] = move;
      const WorldStep step = put(memory, running, move, window, i, batch);
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
  std::vector<uint8_t> episodes;
  std::vector<int64_t> words;
  for (const Running& r : running_) {
    r.episode.save(episodes);
    words.insert(words.end(), {int64_t(r.serial), r.place, r.restarts, r.following, r.started});
  }
  file.add(prefix + "episodes", {int64_t(episodes.size())}, episodes.data(), episodes.size());
  file.add(prefix + "running", {int64_t(words.size())}, words.data(), words.size());
  const int64_t next = int64_t(next_);
  file.add(prefix + "next", {1}, &next, 1);
}

void RunningDraw::load(const SafeTensors& file, const std::string& prefix, const ReplayMemory& memory) {
  constexpr size_t kWords = 5, kBytes = RunningEpisode::kBytes;
  const std::vector<uint8_t> episodes = file.get<uint8_t>(prefix + "episodes");
  const std::vector<int64_t> words = file.get<int64_t>(prefix + "running");
  int64_t next = 0;
  file.get(prefix + "next", &next, 1);
  const auto bad = [&] { fail(Exit::kData, "tensor '", prefix, "running' is malformed"); };
  const size_t count = words.size() / kWords;
  if (words.size() % kWords != 0 || (count > 0 && count < size_t(options_.episodes)) ||
      episodes.size() != count * kBytes)
    bad();
  running_.assign(count, Running{});
  if (next < 0 || (next > 0 && size_t(next) >= count)) bad();
  next_ = size_t(next);
  const int64_t* at = words.data();
  const auto take = [&](int64_t high) {
    if (*at < 0 || *at > high) bad();
    return *at++;
  };
  for (size_t i = 0; i < count; ++i) {
    Running& r = running_[i];
    r.serial = uint64_t(take(INT64_MAX));
    r.place = uint32_t(take(UINT32_MAX));
    r.restarts = uint32_t(take(UINT32_MAX));
    r.following = take(1) != 0;
    r.started = take(1) != 0;
    if (!r.started) continue;
    if (r.place >= memory.size() || !r.episode.load(*world_, episodes.data() + i * kBytes)) bad();
    if (r.following && memory.serial(r.place) == r.serial && r.episode.now().steps >= memory[r.place].actions.size())
      bad();
  }
}

}  // namespace synpo
