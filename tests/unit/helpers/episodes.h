// Episodes for the tests of the learner.
#pragma once
#include <string>
#include <vector>

#include "learn/memory.h"
#include "play/episode.h"
#include "world/grid/grid_set.h"
#include "world/grid/view.h"

namespace synpo {

// The built-in mazes, set up once.
inline const GridSet& builtin_world() {
  static const GridSet world = GridSet::open("gridworld");
  return world;
}

inline Episode expert(EnvTask pair, int64_t number, double noise = 0, uint64_t seed = 1) {
  return replay(builtin_world(), expert_episode(builtin_world(), pair, seed, number, noise, 1));
}

// Lines of a stream: expert episodes of the pairs in turn.
inline std::string expert_lines(const std::vector<EnvTask>& pairs, int count, double noise = 0, int window = 1) {
  std::string lines;
  for (int i = 0; i < count; ++i)
    lines += format_trajectory(expert_episode(builtin_world(), pairs[i % pairs.size()], 1, i, noise, window)) + "\n";
  return lines;
}

// The network's input after these frames, by its definition.
inline std::vector<uint8_t> pictures_of(const Maze& maze, const std::vector<GridFrame>& frames, int window) {
  std::vector<uint8_t> pictures(size_t(kGridCells) * kHistory, kUnseen);
  for (int f = 0; f < kHistory; ++f) {
    const int frame = int(frames.size()) - kHistory + f;
    if (frame < 0) continue;
    uint8_t view[kGridCells];
    draw_view(maze, frames[frame], window, view);
    for (int cell = 0; cell < kGridCells; ++cell) pictures[size_t(cell) * kHistory + f] = view[cell];
  }
  return pictures;
}

}  // namespace synpo
