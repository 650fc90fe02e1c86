// Trajectories: a stream that is replayed; a line that was read is written as one that reads the same.
#include "format/trajectory.h"

#include <memory>

#include "fuzz.h"
#include "play/episode.h"
#include "play/stream.h"
#include "play/world_factory.h"
#include "world/world.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::unique_ptr<World> grid = open_world("gridworld"), kitchens = open_world("kitchen");
  const World* world = grid.get();
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    std::string line;
    while (bytes.input().line(line)) {
      const Trajectory trajectory = parse_trajectory(line, kStepLimit);
      if (trajectory.world == kitchens->name()) world = kitchens.get();
      const std::string again = format_trajectory(trajectory);
      fuzz::require(format_trajectory(parse_trajectory(again, kStepLimit)) == again, "what is written reads the same");
    }
  });
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    TrajectoryStream stream(bytes.input(), *world, {});
    while (stream.next()) {
    }
  });
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    std::string line;
    while (bytes.input().line(line)) replay(*world, relabelled(*world, parse_trajectory(line, kStepLimit)));
  });
  return 0;
}
