#include "play/running_episode.h"

namespace synpo {

void Outcomes::add(const Outcomes& other) {
  episodes += other.episodes;
  successes += other.successes;
  wrong += other.wrong;
  timeouts += other.timeouts;
  reward_cents += other.reward_cents;
  length += other.length;
}

void RunningEpisode::start(EnvTask of, const WorldState& state) {
  *this = {of, {}, 0};
  history.push(state);
}

WorldStep RunningEpisode::step(const World& world, int action) {
  WorldState state = now();
  const WorldStep result = world.step(pair, state, action);
  history.push(state);
  reward_cents += result.reward_cents;
  return result;
}

Outcomes RunningEpisode::outcome(const WorldStep& last) const {
  return {1, last.success, last.wrong, last.truncated, reward_cents, now().steps};
}

}  // namespace synpo
