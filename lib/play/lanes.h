// Episodes that run side by side under the learner's own actions.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "format/safetensors.h"
#include "play/running_episode.h"

namespace synpo {

class Lanes {
 public:
  // Episodes of these pairs, drawn at random, in `count` lanes.
  Lanes(const World& world, std::vector<EnvTask> pairs, int count, int window, uint64_t seed);

  int count() const { return int(lanes_.size()); }
  const std::vector<EnvTask>& pairs() const { return pairs_; }
  int pair(int lane) const { return lanes_[lane].pair; }  // position in pairs()
  // The network's input where the lane stands.
  void observe(int lane, uint8_t* observation) const;

  // One step. An episode that has ended stands at its last state until restart().
  WorldStep step(int lane, int action);
  void restart(int lane);

  struct Finished {
    int64_t episodes = 0, successes = 0, wrong = 0, reward_cents = 0, length = 0;
  };
  // What has ended since the last call.
  Finished take_finished();

  // All that a run needs to go on; load() throws kData for what no save() wrote.
  void save(SafeTensors& file, const std::string& prefix) const;
  void load(const SafeTensors& file, const std::string& prefix);

 private:
  struct Lane {
    int pair = 0;
    RunningEpisode episode;
    int64_t number = 0;  // of the episode in this lane
    int64_t reward_cents = 0;
  };
  const World* world_;
  std::vector<EnvTask> pairs_;
  int window_;
  uint64_t seed_;
  std::vector<Lane> lanes_;
  Finished finished_;
};

}  // namespace synpo
