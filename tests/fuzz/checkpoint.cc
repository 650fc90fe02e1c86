// Checkpoints (fuzz::with_tensors), into a world and a model that acts in it.
#include "format/checkpoint.h"

#include <memory>

#include "base/parallel.h"
#include "fuzz.h"
#include "learn/recipe.h"
#include "play/evaluate.h"
#include "play/model.h"
#include "world/world.h"

using namespace synpo;

namespace {

// It plays an episode of a seen and of an unseen pair.
void act(const World& world, const Model& model) {
  static Parallel parallel(1);
  evaluate_sample(parallel, world, model, model.parameters.data(), model.statistics.data(), 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string file = fuzz::with_tensors(fuzz::text(data, size));
  fuzz::accepts(
      [&] {
        fuzz::Bytes bytes(file);
        Checkpoint checkpoint = read_checkpoint(bytes.input());
        fuzz::require(!checkpoint.describe().empty(), "a checkpoint describes itself");
        fuzz::accepts([&] { parse_options(checkpoint.options); });
        const std::string again = format_checkpoint(checkpoint);
        {
          fuzz::Bytes written(again);
          fuzz::require(format_checkpoint(read_checkpoint(written.input())) == again, "what is written reads the same");
        }
        const std::unique_ptr<World> world = world_of(checkpoint);
        const Model model = load_model(checkpoint, *world);
        if (model.window <= 16) act(*world, model);
      },
      {Exit::kData, Exit::kUsage});
  return 0;
}
