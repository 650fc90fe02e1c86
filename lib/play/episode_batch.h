// Episodes that run side by side in one world, each in a place of its own: those of an evaluation, those that PPO's
// actors play, and those that imitation draws single steps from. Who acts, and what starts where one has ended, is
// their owner's to say.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/safetensors.h"
#include "play/running_episode.h"
#include "world/world.h"

namespace synpo {

class EpisodeBatch {
 public:
  explicit EpisodeBatch(const World& world, int places = 0) : world_(&world), episodes_(size_t(places)) {}

  int size() const { return int(episodes_.size()); }
  // Places that are new are empty until an episode starts there.
  void resize(int places) { episodes_.resize(size_t(places)); }
  // Different places may be used from different threads.
  RunningEpisode& operator[](int place) { return episodes_[size_t(place)]; }
  const RunningEpisode& operator[](int place) const { return episodes_[size_t(place)]; }

  // The network's inputs at these places, one after the other.
  void observe(std::span<const int> places, int window, uint8_t* observations) const;

  // All places as one tensor of bytes; rewards so far are not in it. load() gives false for what no save() of so many
  // places in this world wrote.
  void save(SafeTensors& file, const std::string& name) const;
  bool load(const SafeTensors& file, const std::string& name, int places);

 private:
  size_t bytes_each() const;

  const World* world_;
  std::vector<RunningEpisode> episodes_;
};

}  // namespace synpo
