// Rates of the worlds, the formats and the network step, for scripts/bench.
//   synpo-bench rows                     TSV rows name, value, unit of everything but the step
//   synpo-bench train|forward B THREADS  states per second of the Table 2 network at batch B
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>
#include <algorithm>

#include "base/parallel.h"
#include "base/random.h"
#include "nn/adam.h"
#include "nn/gemm.h"
#include "policy/synpo.h"
#include "world/gridworld.h"
#include "world/planner.h"
#include "world/view.h"

using namespace synpo;
using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct RandomBatch {
  std::vector<uint8_t> pictures;
  std::vector<int> env, task, label, taken;
  std::vector<float> reward;
  StepBatch<float> batch;

  explicit RandomBatch(int n) : pictures(size_t(n) * kGridCells * kHistory), env(n), task(n), label(n), taken(n), reward(n) {
    const std::vector<Maze>& mazes = builtin_mazes();
    for (int i = 0; i < n; ++i) {
      Random random(1, Purpose::kEpisodeStart, 0, i);
      env[i] = int(random.below(20));
      task[i] = int(random.below(20));
      if (random.below(400) < 256) task[i] = (env[i] + int(random.below(7))) % 20;  // about 144 distinct pairs
      label[i] = int(random.below(kGridActions));
      taken[i] = label[i];
      reward[i] = -0.01f;
      uint8_t colours[kGridCells];
      const GridState state = grid_reset(mazes[env[i]], random);
      draw_view(mazes[env[i]], state.now, 1, colours);
      for (int cell = 0; cell < kGridCells; ++cell)
        for (int f = 0; f < kHistory; ++f) pictures[(size_t(i) * kGridCells + cell) * kHistory + f] = colours[cell];
    }
    batch = {n, pictures.data(), env.data(), task.data(), label.data(), taken.data(), reward.data()};
  }
};

// States per second: median over repeats of about half a second each.
template <class Work>
double rate(int states, double limit_s, Work&& work) {
  work();
  std::vector<double> rates;
  const auto start = Clock::now();
  while (rates.size() < 3 || seconds_since(start) < limit_s) {
    int done = 0;
    const auto begin = Clock::now();
    do work(), done += states;
    while (seconds_since(begin) < 0.5);
    rates.push_back(done / seconds_since(begin));
  }
  std::nth_element(rates.begin(), rates.begin() + rates.size() / 2, rates.end());
  return rates[rates.size() / 2];
}

double network_rate(bool train, int n, int threads) {
  Parallel parallel(threads);
  SynPo<float> policy{PolicyShape()};
  const size_t count = policy.parameters().total();
  Buffer<float> parameters(count), statistics(policy.statistics().total()), gradient(count), m(count), v(count), logits(size_t(n) * kGridActions);
  policy.initialise({}, parameters.data(), statistics.data());
  m.zero();
  v.zero();
  const RandomBatch data(n);
  int64_t step = 0;
  if (train)
    return rate(n, 8, [&] {
      policy.step(parallel, data.batch, {0.01, 0.1, 0.1}, parameters.data(), statistics.data(), gradient.data(), logits.data());
      adam_step(parallel, {}, ++step, count, gradient.data(), parameters.data(), m.data(), v.data());
    });
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < 400; ++i) pairs.emplace_back(i / 20, i % 20);
  std::vector<int> pair(n);
  for (int i = 0; i < n; ++i) pair[i] = data.env[i] * 20 + data.task[i];
  policy.prepare_inference(parallel, parameters.data(), statistics.data(), pairs);
  constexpr int kUnit = Policy<float>::kInferenceUnit;
  return rate(n, 8, [&] {
    parallel.run(shard_count(n, kUnit), [&](int shard, int thread) {
      const Range range = shard_range(n, kUnit, shard);
      policy.infer(thread, range.size(), data.pictures.data() + size_t(range.begin) * kGridCells * kHistory, pair.data() + range.begin,
                   logits.data() + size_t(range.begin) * kGridActions);
    });
  });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (argc == 4 && (what == "train" || what == "forward")) {
    std::printf("%.0f\n", network_rate(what == "train", std::atoi(argv[2]), std::atoi(argv[3])));
    return 0;
  }
  return 64;
}
