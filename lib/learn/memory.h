// The replay memory: the last `capacity` trajectories of the stream.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "format/safetensors.h"
#include "play/episode.h"
#include "world/world.h"

namespace synpo {

class ReplayMemory {
 public:
  explicit ReplayMemory(size_t capacity) : capacity_(capacity) {}
  void add(Episode episode);
  size_t size() const { return episodes_.size(); }
  const Episode& operator[](size_t i) const { return episodes_[i]; }
  // Number of the trajectory at position i, counted from the stream's first: another one where the place has been taken
  // over since.
  uint64_t serial(size_t i) const { return serials_[i]; }

  void save(SafeTensors& file, const std::string& prefix, const World& world) const;
  // Throws kData for what no save() wrote.
  void load(const SafeTensors& file, const std::string& prefix, const World& world);

 private:
  size_t capacity_;
  uint64_t added_ = 0;
  std::vector<Episode> episodes_;
  std::vector<uint64_t> serials_;
};

}  // namespace synpo
