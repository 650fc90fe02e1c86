// Maps, into the maze that they are.
#include <string>
#include <vector>

#include "base/random.h"
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
    Random random(1, Purpose::kEpisodeStart);
    const EnvTask pair = {0, int(random.below(uint32_t(world.task_count())))};
    WorldState state = world.reset(0, random);
    fuzz::require(world.start_state(0, world.start_places(0, state)) == state, "a start has places");
    StateHistory history = {};
    history.push(state);
    world.observe(0, history, 1, seen.data());
    bool ended = false;
    for (int step = 0; step < kStepLimit && !ended; ++step) {
      fuzz::require(world.valid(pair, state), "a state of an episode is valid");
      const WorldStep result = world.step(pair, state, world.expert(pair, state));
      fuzz::require(!result.wrong, "the planner does nothing wrong");
      ended = result.ended();
    }
    fuzz::require(ended, "an episode ends");
  });
  return 0;
}
