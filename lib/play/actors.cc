#include "play/actors.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/random.h"

namespace synpo {

Actors::Actors(const World& world, std::vector<EnvTask> pairs, int count, uint64_t seed)
    : world_(&world), pairs_(std::move(pairs)), seed_(seed), episodes_(world, count), actors_(size_t(count)) {
  for (int actor = 0; actor < count; ++actor) restart(actor);
}

WorldStep Actors::step(int actor, int action) {
  RunningEpisode& episode = episodes_[actor];
  const WorldStep step = episode.step(*world_, action);
  if (step.ended()) finished_.add(episode.outcome(step));
  return step;
}

void Actors::restart(int number) {
  Actor& actor = actors_[size_t(number)];
  ++actor.number;
  Random random(seed_, Purpose::kActor, uint64_t(number), uint64_t(actor.number));
  actor.pair = int(random.below(uint32_t(pairs_.size())));
  const EnvTask pair = pairs_[size_t(actor.pair)];
  episodes_[number].start(pair, world_->reset(pair.env, random));
}

Outcomes Actors::take_finished() { return std::exchange(finished_, {}); }

void Actors::save(SafeTensors& file, const std::string& prefix) const {
  std::vector<int64_t> numbers, rewards;
  for (int actor = 0; actor < count(); ++actor) {
    numbers.push_back(actors_[size_t(actor)].number);
    rewards.push_back(episodes_[actor].reward_cents);
  }
  episodes_.save(file, prefix + "episodes");
  file.add(prefix + "numbers", {int64_t(numbers.size())}, numbers.data(), numbers.size());
  file.add(prefix + "rewards", {int64_t(rewards.size())}, rewards.data(), rewards.size());
}

void Actors::load(const SafeTensors& file, const std::string& prefix) {
  const auto bad = [] { fail(Exit::kData, "the running episodes in the checkpoint are malformed"); };
  if (!episodes_.load(file, prefix + "episodes", count())) bad();
  const std::vector<int64_t> numbers = file.get<int64_t>(prefix + "numbers"),
                             rewards = file.get<int64_t>(prefix + "rewards");
  if (numbers.size() != actors_.size() || rewards.size() != actors_.size()) bad();
  for (size_t i = 0; i < actors_.size(); ++i) {
    RunningEpisode& episode = episodes_[int(i)];
    const auto pair = std::find(pairs_.begin(), pairs_.end(), episode.pair);
    if (episode.history.count == 0 || pair == pairs_.end() || numbers[i] < 1 || numbers[i] == INT64_MAX ||
        rewards[i] < -INT32_MAX || rewards[i] > INT32_MAX)
      bad();
    actors_[i] = {int(pair - pairs_.begin()), numbers[i]};
    episode.reward_cents = rewards[i];
  }
}

}  // namespace synpo
