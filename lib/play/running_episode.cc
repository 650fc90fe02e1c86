#include "play/running_episode.h"

#include <algorithm>

namespace synpo {
namespace {

void put(std::vector<uint8_t>& to, int number) { to.insert(to.end(), {uint8_t(number), uint8_t(number >> 8)}); }

int take(const uint8_t*& from) {
  const int number = from[0] | from[1] << 8;
  from += 2;
  return number;
}

}  // namespace

void RunningEpisode::save(std::vector<uint8_t>& to) const {
  put(to, pair.env);
  put(to, pair.task);
  to.push_back(history.count);
  for (const WorldState& state : history.states) {
    to.insert(to.end(), state.bytes.begin(), state.bytes.end());
    put(to, state.steps);
  }
}

bool RunningEpisode::load(const World& world, const uint8_t* from) {
  pair.env = take(from);
  pair.task = take(from);
  history.count = *from++;
  if (pair.env >= world.envs() || pair.task >= world.task_count() || history.count < 1 || history.count > kHistory)
    return false;
  for (int i = 0; i < kHistory; ++i) {
    WorldState& state = history.states[i];
    std::copy_n(from, state.bytes.size(), state.bytes.begin());
    from += state.bytes.size();
    state.steps = uint16_t(take(from));
    if (i >= kHistory - history.count && !world.valid(pair, state)) return false;
  }
  return true;
}

}  // namespace synpo
