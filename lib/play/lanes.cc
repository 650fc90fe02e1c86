#include "play/lanes.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/error.h"

namespace synpo {

Lanes::Lanes(const World& world, std::vector<EnvTask> pairs, int count, int window, uint64_t seed)
    : world_(&world), pairs_(std::move(pairs)), window_(window), seed_(seed), lanes_(count) {
  for (int lane = 0; lane < count; ++lane) restart(lane);
}

void Lanes::observe(int lane, uint8_t* observation) const {
  const RunningEpisode& episode = lanes_[lane].episode;
  world_->observe(episode.pair.env, episode.history, window_, observation);
}

WorldStep Lanes::step(int number, int action) {
  Lane& lane = lanes_[number];
  const WorldStep step = lane.episode.step(*world_, action);
  lane.reward_cents += step.reward_cents;
  if (step.ended()) {
    ++finished_.episodes;
    finished_.successes += step.success;
    finished_.wrong += step.wrong;
    finished_.reward_cents += lane.reward_cents;
    finished_.length += lane.episode.now().steps;
  }
  return step;
}

void Lanes::restart(int number) {
  Lane& lane = lanes_[number];
  ++lane.number;
  lane.reward_cents = 0;
  Random random(seed_, Purpose::kLane, uint64_t(number), uint64_t(lane.number));
  lane.pair = int(random.below(uint32_t(pairs_.size())));
  const EnvTask pair = pairs_[lane.pair];
  lane.episode.start(pair, world_->reset(pair.env, random));
}

Lanes::Finished Lanes::take_finished() { return std::exchange(finished_, {}); }

void Lanes::save(SafeTensors& file, const std::string& prefix) const {
  std::vector<uint8_t> episodes;
  std::vector<int64_t> numbers, rewards;
  for (const Lane& lane : lanes_) {
    lane.episode.save(episodes);
    numbers.push_back(lane.number);
    rewards.push_back(lane.reward_cents);
  }
  file.add(prefix + "episodes", {int64_t(episodes.size())}, episodes.data(), episodes.size());
  file.add(prefix + "numbers", {int64_t(numbers.size())}, numbers.data(), numbers.size());
  file.add(prefix + "rewards", {int64_t(rewards.size())}, rewards.data(), rewards.size());
}

void Lanes::load(const SafeTensors& file, const std::string& prefix) {
  const std::vector<uint8_t> episodes = file.get<uint8_t>(prefix + "episodes");
  const std::vector<int64_t> numbers = file.get<int64_t>(prefix + "numbers"),
                             rewards = file.get<int64_t>(prefix + "rewards");
  const auto bad = [&] { fail(Exit::kData, "the running episodes in the checkpoint are malformed"); };
  if (numbers.size() != lanes_.size() || rewards.size() != lanes_.size() ||
      episodes.size() != lanes_.size() * RunningEpisode::kBytes)
    bad();
  for (size_t i = 0; i < lanes_.size(); ++i) {
    lanes_[i] = {0, {}, numbers[i], rewards[i]};
    if (numbers[i] < 1 || numbers[i] == INT64_MAX || rewards[i] < -INT32_MAX || rewards[i] > INT32_MAX) bad();
    if (!lanes_[i].episode.load(*world_, episodes.data() + i * RunningEpisode::kBytes)) bad();
    const auto pair = std::find(pairs_.begin(), pairs_.end(), lanes_[i].episode.pair);
    if (pair == pairs_.end()) bad();
    lanes_[i].pair = int(pair - pairs_.begin());
  }
}

}  // namespace synpo
