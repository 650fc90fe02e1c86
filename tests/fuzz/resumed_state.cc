// What a resumed training has kept: its memory, its running episodes, and PPO's actors. The input is a byte that picks
// the world, and tensors in the order of kTensors, each as a length in two bytes, the low one first, and its bytes.
#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "format/safetensors.h"
#include "fuzz.h"
#include "learn/memory.h"
#include "learn/steps.h"
#include "play/actors.h"
#include "play/world_factory.h"
#include "world/world.h"

using namespace synpo;

namespace {

struct NamedType {
  const char* name;
  TensorType type;
};
constexpr NamedType kTensors[] = {
    {"memory/episodes", TensorType::kU8},  {"memory/serials", TensorType::kU64},  {"memory/added", TensorType::kU64},
    {"running/episodes", TensorType::kU8}, {"running/running", TensorType::kI64}, {"running/next", TensorType::kI64},
    {"lanes/episodes", TensorType::kU8},   {"lanes/numbers", TensorType::kI64},   {"lanes/rewards", TensorType::kI64}};

SafeTensors tensors_of(std::string_view input) {
  SafeTensors file;
  for (const auto& [name, type] : kTensors) {
    size_t length = 0;
    if (input.size() >= 2) {
      length = uint8_t(input[0]) | size_t(uint8_t(input[1])) << 8;
      input.remove_prefix(2);
    }
    length = std::min(length, input.size()) / type_size(type) * type_size(type);
    file.tensors[name] = {type, {int64_t(length / type_size(type))}, std::string(input.substr(0, length))};
    input.remove_prefix(length);
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::unique_ptr<World> grid = open_world("gridworld"), kitchens = open_world("kitchen");
  static Parallel parallel(1);
  if (size == 0) return 0;
  // Observations of kitchens cost milliseconds.
  const bool in_kitchens = data[0] % 64 == 1;
  const World& world = in_kitchens ? *kitchens : *grid;
  const SafeTensors file = tensors_of(fuzz::text(data + 1, size - 1));
  fuzz::accepts([&] {
    ReplayMemory memory(8);
    memory.load(file, "memory/", world);
    SafeTensors again;
    memory.save(again, "memory/", world);
    if (memory.size() == 0) return;
    Minibatch batch;
    batch.needs = {true, true};
    TrajectoryDraw::draw(world, memory, parallel, 1, 1, 1, 0, batch);
    RunningOptions options;
    options.episodes = 4;
    options.roll_in = 0.5;
    options.noise = 0.1;
    RunningDraw running(world, options, 1);
    running.load(file, "running/", memory);
    for (int64_t update = 0; update < 2; ++update) {
      running.draw(memory, parallel, 4, 1, update, batch);
      running.advance(memory, std::vector<int>(size_t(batch.size()), int(update)), update);
    }
    running.save(again, "running/");
  });
  fuzz::accepts([&] {
    Actors actors(world, {{0, 0}, {1, 1}, {2, 3}}, 4, 1);
    actors.load(file, "lanes/");
    std::vector<uint8_t> seen(world.observation_size());
    for (int step = 0; step < 4; ++step)
      for (int actor = 0; actor < actors.count(); ++actor) {
        if (step == 0) actors.episodes()[actor].observe(world, 1, seen.data());
        if (actors.step(actor, (step + actor) % world.actions()).ended()) actors.restart(actor);
      }
    actors.take_finished();
  });
  return 0;
}
