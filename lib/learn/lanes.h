// Episodes that run side by side under the learner's own actions.
#pragma once
#include <cstdint>
#include <vector>

#include "learn/episode.h"
#include "world/view.h"

namespace synpo {

class Lanes {
 public:
  // Episodes of these pairs, drawn at random, in `count` lanes.
  Lanes(const GridSet& world, std::vector<EnvTask> pairs, int count, int window, uint64_t seed);

  int count() const { return int(lanes_.size()); }
  const std::vector<EnvTask>& pairs() const { return pairs_; }
  int pair(int lane) const { return lanes_[lane].pair; }  // position in pairs()
  // The network's input where the lane stands.
  void draw(int lane, uint8_t* pictures) const;

  // One step. An episode that has ended stands at its last state until restart().
  GridStep step(int lane, int action);
  void restart(int lane);

  struct Finished {
    int64_t episodes = 0, successes = 0, wrong = 0, reward_cents = 0, length = 0;
  };
  // What has ended since the last call.
  Finished take_finished();

  static constexpr int kWords = 6 + (1 + kHistory) * (1 + kTreasures);  // of a lane in words()
  // All that a run needs to go on, and back; load throws kData for what no words() gave.
  std::vector<int64_t> words() const;
  void load(const std::vector<int64_t>& words);

 private:
  struct Lane {
    int pair = 0;
    int64_t episode = 0;  // number of the episode in this lane
    GridState state;
    GridHistory history;
    int64_t reward_cents = 0;
  };
  const GridSet* world_;
  std::vector<EnvTask> pairs_;
  int window_;
  uint64_t seed_;
  std::vector<Lane> lanes_;
  Finished finished_;
};

}  // namespace synpo
