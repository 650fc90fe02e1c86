#include "play/episode_batch.h"

#include <algorithm>

#include "world/observation.h"

namespace synpo {
namespace {

// A place is [env, task, remembered states], then kHistory states of [bytes, steps]; env, task and steps are two bytes,
// the low one first. An empty place is all zero.
constexpr size_t kHeadBytes = 5, kStepsBytes = 2;

void put(std::vector<uint8_t>& to, int number) { to.insert(to.end(), {uint8_t(number), uint8_t(number >> 8)}); }

int take(const uint8_t*& from) {
  const int number = from[0] | from[1] << 8;
  from += 2;
  return number;
}

void save_episode(const World& world, const RunningEpisode& episode, std::vector<uint8_t>& to) {
  put(to, episode.pair.env);
  put(to, episode.pair.task);
  to.push_back(episode.history.count);
  for (const WorldState& state : episode.history.states) {
    to.insert(to.end(), state.bytes.begin(), state.bytes.begin() + std::ptrdiff_t(world.state_bytes()));
    put(to, state.steps);
  }
}

// False for bytes that no running episode of this world gives.
bool load_episode(const World& world, const uint8_t* from, RunningEpisode& episode) {
  episode = {};
  episode.pair.env = take(from);
  episode.pair.task = take(from);
  StateHistory& history = episode.history;
  history.count = *from++;
  if (episode.pair.env >= world.envs() || episode.pair.task >= world.task_count() || history.count > kHistory)
    return false;
  for (int i = 0; i < kHistory; ++i) {
    WorldState& state = history.states[size_t(i)];
    std::copy_n(from, world.state_bytes(), state.bytes.begin());
    from += world.state_bytes();
    state.steps = uint16_t(take(from));
    if (i >= kHistory - history.count && !world.valid(episode.pair, state)) return false;
  }
  return true;
}

}  // namespace

void EpisodeBatch::observe(std::span<const int> places, int window, uint8_t* observations) const {
  for (const int place : places) {
    (*this)[place].observe(*world_, window, observations);
    observations += world_->observation_size();
  }
}

size_t EpisodeBatch::bytes_each() const { return kHeadBytes + kHistory * (world_->state_bytes() + kStepsBytes); }

void EpisodeBatch::save(SafeTensors& file, const std::string& name) const {
  std::vector<uint8_t> bytes;
  for (const RunningEpisode& episode : episodes_) save_episode(*world_, episode, bytes);
  file.add(name, {int64_t(bytes.size())}, bytes.data(), bytes.size());
}

bool EpisodeBatch::load(const SafeTensors& file, const std::string& name, int places) {
  const std::vector<uint8_t> bytes = file.get<uint8_t>(name);
  if (bytes.size() != size_t(places) * bytes_each()) return false;
  episodes_.resize(size_t(places));
  for (size_t place = 0; place < episodes_.size(); ++place)
    if (!load_episode(*world_, bytes.data() + place * bytes_each(), episodes_[place])) return false;
  return true;
}

}  // namespace synpo
