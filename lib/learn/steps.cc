#include "learn/steps.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"

namespace synpo {
namespace {

constexpr int kUnit = 32;  // samples of a shard
constexpr uint64_t kRestartStream = uint64_t{1}
                                    << 32;  // keeps restarts and updates apart among the numbers of Purpose::kRollIn

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

void Minibatch::put(int at, const World& world, const RunningEpisode& episode, int window, int right, int action,
                    const WorldStep& step) {
  const size_t row = size_t(at);
  episode.observe(world, window, observations.data() + row * world.observation_size());
  env[row] = episode.pair.env;
  task[row] = episode.pair.task;
  label[row] = right;
  taken[row] = action;
  reward[row] = float(step.reward_cents) / 100;
  kind[row] = world.kind(episode.pair, episode.now(), right);
  if (!needs.planner_q) return;
  const size_t actions = size_t(world.actions());
  std::vector<int> cents(actions);
  world.action_values(episode.pair, episode.now(), cents.data());
  for (size_t a = 0; a < actions; ++a) planner_q[row * actions + a] = float(cents[a]) / 100;
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
      const int at = first[i] + int(t);
      const RunningEpisode before = running;
      const WorldStep step = running.step(world, episode.actions[t]);
      batch.put(at, world, before, window, episode.labels[t], episode.actions[t], step);
      if (!batch.needs.next) continue;
      if (step.terminated)
        batch.next[at] = StepBatch<float>::kTerminal;
      else if (t + 1 < episode.actions.size())
        batch.next[at] = at + 1;
    }
  });
}

const Episode* RunningDraw::followed(const ReplayMemory& memory, const RunningEpisode& episode, const Track& track) {
  if (!track.following || memory.serial(track.place) != track.serial) return nullptr;
  const Episode& trajectory = memory[track.place];
  // A recorded trajectory may break off before its episode ends.
  return episode.now().steps < trajectory.actions.size() ? &trajectory : nullptr;
}

RunningDraw::Choice RunningDraw::choose(const ReplayMemory& memory, const RunningEpisode& episode,
                                        const Track& track) const {
  const size_t steps = episode.now().steps;
  if (const Episode* trajectory = followed(memory, episode, track))
    return {trajectory->labels[steps], trajectory->actions[steps]};
  const int label = world_->expert(episode.pair, episode.now());
  return {label, label};
}

WorldStep RunningDraw::move_on(const ReplayMemory& memory, RunningEpisode& episode, Track& track, int action) const {
  const Episode* trajectory = followed(memory, episode, track);
  track.following = trajectory && trajectory->actions[episode.now().steps] == action;
  return episode.step(*world_, action);
}

void RunningDraw::restart(const ReplayMemory& memory, uint32_t number) {
  Track& track = tracks_[number];
  Random random(seed_, Purpose::kRollIn, number, kRestartStream + track.restarts);
  const uint32_t place = random.below(uint32_t(memory.size()));
  const Episode& trajectory = memory[place];
  track = {memory.serial(place), place, track.restarts + 1, !options_.fresh_starts, true};
  const EnvTask pair = trajectory.pair;
  episodes_[int(number)].start(pair, options_.fresh_starts ? world_->reset(pair.env, random) : trajectory.start);
}

void RunningDraw::step(const ReplayMemory& memory, uint32_t number, int action) {
  RunningEpisode& episode = episodes_[int(number)];
  if (move_on(memory, episode, tracks_[number], action).ended() || episode.now().steps >= options_.step_limit)
    restart(memory, number);
}

RunningDraw::Choice RunningDraw::go_on(const ReplayMemory& memory, uint32_t number, int64_t update) {
  const RunningEpisode& episode = episodes_[int(number)];
  const Track& track = tracks_[number];
  Random random(seed_, Purpose::kRollIn, number, uint64_t(update));
  if (!track.started) {
    // Episodes that all began together would stay together: each goes some way with the expert first.
    restart(memory, number);
    for (uint32_t skip = random.below(40); skip > 0; --skip) step(memory, number, choose(memory, episode, track).move);
  }
  while (true) {
    Choice choice = choose(memory, episode, track);
    if (options_.noise > 0 && random.uniform() < options_.noise)
      choice.move = int(random.below(uint32_t(world_->moves())));
    if (world_->at_choice(episode.pair, episode.now()) || random.uniform() < options_.balance) return choice;
    step(memory, number, choice.move);
  }
}

void RunningDraw::draw(const ReplayMemory& memory, Parallel& parallel, int count, int window, int64_t update,
                       Minibatch& batch) {
  if (batch.needs.next) count = (count + 1) / 2;
  // Never fewer than a minibatch takes: an episode is drawn once.
  if (episodes_.size() < count) {
    episodes_.resize(std::max(options_.episodes, count));
    tracks_.resize(size_t(episodes_.size()));
  }
  batch.resize(*world_, batch.needs.next ? 2 * count : count);
  drawn_.resize(count);
  moves_.resize(count);
  for (int i = 0; i < count; ++i) {
    drawn_[i] = uint32_t(next_);
    next_ = (next_ + 1) % tracks_.size();
  }
  parallel.run(shard_count(count, kUnit), [&](int shard, int) {
    const Range range = shard_range(count, kUnit, shard);
    for (int i = range.begin; i < range.end; ++i) {
      const uint32_t number = drawn_[i];
      const Choice choice = go_on(memory, number, update);
      moves_[i] = choice.move;
      const RunningEpisode& episode = episodes_[int(number)];
      RunningEpisode after = episode;
      Track track = tracks_[number];
      const WorldStep step = move_on(memory, after, track, choice.move);
      batch.put(i, *world_, episode, window, choice.label, choice.move, step);
      if (!batch.needs.next) continue;
      const int next = count + i;
      batch.next[i] = step.terminated ? StepBatch<float>::kTerminal : next;
      if (step.terminated) {  // a last step stands twice, the second time with none after it
        after = episode;
        track = tracks_[number];
      }
      const RunningEpisode then = after;
      const Choice next_choice = choose(memory, then, track);
      batch.put(next, *world_, then, window, next_choice.label, next_choice.move,
                after.step(*world_, next_choice.move));
    }
  });
}

void RunningDraw::advance(const ReplayMemory& memory, const std::vector<int>& greedy, int64_t update) {
  for (size_t i = 0; i < drawn_.size(); ++i) {
    const uint32_t number = drawn_[i];
    Random random(seed_, Purpose::kOwnMove, number, uint64_t(update));
    const bool own = options_.roll_in > 0 && random.uniform() < options_.roll_in;
    step(memory, number, own ? greedy[i] : moves_[i]);
  }
}

void RunningDraw::save(SafeTensors& file, const std::string& prefix) const {
  std::vector<int64_t> words;
  for (const Track& t : tracks_)
    words.insert(words.end(), {int64_t(t.serial), t.place, t.restarts, t.following, t.started});
  episodes_.save(file, prefix + "episodes");
  file.add(prefix + "running", {int64_t(words.size())}, words.data(), words.size());
  const int64_t next = int64_t(next_);
  file.add(prefix + "next", {1}, &next, 1);
}

void RunningDraw::load(const SafeTensors& file, const std::string& prefix, const ReplayMemory& memory) {
  constexpr size_t kWords = 5;
  const std::vector<int64_t> words = file.get<int64_t>(prefix + "running");
  int64_t next = 0;
  file.get(prefix + "next", &next, 1);
  const auto bad = [&] { fail(Exit::kData, "tensor '", prefix, "running' is malformed"); };
  const size_t count = words.size() / kWords;
  if (words.size() % kWords != 0 || (count > 0 && count < size_t(options_.episodes)) || count > INT32_MAX ||
      !episodes_.load(file, prefix + "episodes", int(count)))
    bad();
  if (next < 0 || (next > 0 && size_t(next) >= count)) bad();
  next_ = size_t(next);
  tracks_.assign(count, Track());
  const int64_t* at = words.data();
  const auto take = [&](int64_t high) {
    if (*at < 0 || *at > high) bad();
    return *at++;
  };
  for (size_t i = 0; i < count; ++i) {
    Track& t = tracks_[i];
    const RunningEpisode& episode = episodes_[int(i)];
    t.serial = uint64_t(take(INT64_MAX));
    t.place = uint32_t(take(UINT32_MAX));
    t.restarts = uint32_t(take(UINT32_MAX));
    t.following = take(1) != 0;
    t.started = take(1) != 0;
    if (!t.started) continue;
    if (t.place >= memory.size() || episode.history.count == 0) bad();
  }
}

}  // namespace synpo
