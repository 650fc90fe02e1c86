// The actors of PPO: each plays episodes of some pairs, drawn at random, one after the other, by the learner's own
// actions.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "format/safetensors.h"
#include "play/episode_batch.h"
#include "play/running_episode.h"
#include "world/world.h"

namespace synpo {

class Actors {
 public:
  Actors(const World& world, std::vector<EnvTask> pairs, int count, uint64_t seed);

  int count() const { return episodes_.size(); }
  const std::vector<EnvTask>& pairs() const { return pairs_; }
  const EpisodeBatch& episodes() const { return episodes_; }                // one an actor
  int pair_number(int actor) const { return actors_[size_t(actor)].pair; }  // position in pairs()

  // One step. An episode that has ended stands at its last state until restart().
  WorldStep step(int actor, int action);
  void restart(int actor);

  // The episodes that have ended since the last call.
  Outcomes take_finished();

  // All that a run needs to go on; load() throws kData for what no save() wrote.
  void save(SafeTensors& file, const std::string& prefix) const;
  void load(const SafeTensors& file, const std::string& prefix);

 private:
  struct Actor {
    int pair = 0;
    int64_t number = 0;  // of its episode, counted from 1
  };
  const World* world_;
  std::vector<EnvTask> pairs_;
  uint64_t seed_;
  EpisodeBatch episodes_;
  std::vector<Actor> actors_;
  Outcomes finished_;
};

}  // namespace synpo
