// A palette for pictures that have more colours than it: those that are seen most are in it as they are.
#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/rgb.h"

namespace synpo {

class Palette {
 public:
  // Counts a pixel.
  void add(Rgb colour) { ++entries_[key(colour)].count; }
  // Chooses at most so many colours for all that was counted.
  void choose(size_t most);
  const std::vector<Rgb>& colours() const { return colours_; }
  // Of a colour that was counted: the position of the one that stands for it.
  int index(Rgb colour) const { return entries_.at(key(colour)).index; }

 private:
  static uint32_t key(Rgb colour) { return uint32_t(colour.r) << 16 | uint32_t(colour.g) << 8 | colour.b; }
  struct Entry {
    int64_t count = 0;
    int index = 0;
  };
  std::unordered_map<uint32_t, Entry> entries_;
  std::vector<Rgb> colours_;
};

}  // namespace synpo
