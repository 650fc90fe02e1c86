// How often a checkpoint's policy succeeds, over all pairs of its world:
//   g++ -std=c++20 -O2 success.cc $(pkg-config --cflags --libs synpo) -o success
//   ./success synpo.ckpt
#include <play/episode.h>
#include <play/evaluate.h>
#include <play/model.h>

#include <cstdio>

using namespace synpo;

int main(int, char** arguments) try {
  const Checkpoint checkpoint = load_checkpoint(arguments[1] ? arguments[1] : "-");
  const std::unique_ptr<World> world = world_of(checkpoint);
  Model model = load_model(checkpoint, *world);
  Parallel parallel(0);
  const MatrixPlan plan = {.pairs = all_pairs(*world), .count = 1, .temperature = model.policy->temperature()};
  int64_t successes = 0;
  for (const MatrixRow& row : success_matrix(parallel, *world, model, "", plan).rows) successes += row.successes;
  std::printf("%lld of %zu\n", (long long)successes, plan.pairs.size());
} catch (const Error& error) {
  std::fprintf(stderr, "success: %s\n", error.what());
  return int(error.code());
}
