// Maps, into the maze that they are.
#include <string>
#include <vector>

#include "episode.h"
#include "fuzz.h"
#include "world/grid/grid_set.h"
#include "world/grid/maze.h"
#include "world/world.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::accepts([&] {
    const Maze maze = parse_maze("fuzz", std::string(fuzz::text(data, size)), "bytes");
    const Maze again = parse_maze("fuzz", maze.canonical_text(), "bytes");
    fuzz::require(again.wall == maze.wall && again.hash == maze.hash, "canonical text reads the same");
    const GridSet world({maze});
    std::vector<uint8_t> seen(world.observation_size());
    StateHistory history = {};
    history.push(fuzz::play(world));
    world.observe(0, history, 1, seen.data());
  });
  return 0;
}
