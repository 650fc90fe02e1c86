// Plans of kitchens, into the kitchen that they are.
#include <string>
#include <vector>

#include "base/random.h"
#include "fuzz.h"
#include "world/kitchen/geometry/kitchen.h"
#include "world/kitchen/kitchen_set.h"
#include "world/world.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::accepts([&] {
    const Kitchen kitchen = parse_kitchen("fuzz", std::string(fuzz::text(data, size)), "bytes");
    const Kitchen again = parse_kitchen("fuzz", kitchen.text, "bytes");
    fuzz::require(again.text == kitchen.text && again.hash == kitchen.hash, "canonical text reads the same");
    const KitchenSet world({kitchen});
    Random random(1, Purpose::kEpisodeStart);
    const EnvTask pair = {0, int(random.below(uint32_t(world.task_count())))};
    WorldState state = world.reset(0, random);
    fuzz::require(world.start_state(0, world.start_places(0, state)) == state, "a start has places");
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
