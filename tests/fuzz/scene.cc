// Scenes (fuzz::with_tensors), into the kitchen that they are.
#include "format/scene.h"

#include <utility>
#include <vector>

#include "base/random.h"
#include "fuzz.h"
#include "play/kitchen_scenes.h"
#include "world/kitchen/recorded_kitchens.h"
#include "world/world.h"

using namespace synpo;

namespace {

void play(const World& world) {
  std::vector<uint8_t> seen(world.observation_size());
  for (uint64_t episode = 0; episode < 2; ++episode) {
    Random random(episode, Purpose::kEpisodeStart);
    const EnvTask pair = {0, int(random.below(uint32_t(world.task_count())))};
    StateHistory history = {};
    WorldState state = world.reset(0, random);
    fuzz::require(world.start_state(0, world.start_places(0, state)) == state, "a start has places");
    for (int step = 0; step < 8; ++step) {
      history.push(state);
      fuzz::require(world.valid(pair, state), "a state of an episode is valid");
      world.observe(0, history, 1, seen.data());
      const int action = step % 2 == 0 ? world.expert(pair, state) : int(random.below(uint32_t(world.actions())));
      if (world.step(pair, state, action).ended()) break;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string file = fuzz::with_tensors(fuzz::text(data, size));
  fuzz::accepts([&] {
    fuzz::Bytes bytes(file);
    Scene scene = read_scene(bytes.input());
    const std::string again = format_scene(scene);
    {
      fuzz::Bytes written(again);
      fuzz::require(format_scene(read_scene(written.input())) == again, "what is written reads the same");
    }
    std::vector<RecordedKitchen> kitchens;
    kitchens.push_back(to_kitchen(std::move(scene)));
    play(RecordedKitchens(std::move(kitchens)));
  });
  return 0;
}
