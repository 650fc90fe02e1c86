// Rates of the worlds, the formats and the network step, for scripts/bench.
//   synpo-bench rows                     TSV rows name, value, unit of everything but the step
//   synpo-bench methods                  the rows of these that compare methods, and those of the head
//   synpo-bench train|forward B[,B...] THREADS [DEVICE [PRECISION]]
//                                        states per second of the Table 2 network at batch B, a line each
//   synpo-bench kitchen B THREADS [DEVICE [PRECISION]]
//                                        the training step of the kitchens' network, that of Table 3, on random
//                                        features
//   synpo-bench shards B THREADS         how a training step is cut for so many threads, whatever this machine has
//   synpo-bench scaling THREADS          what so many threads gain over one: the bare product, and the step and the
//                                        scores beside it; TSV rows name, one thread, all, gain, part of product's gain
//   synpo-bench ppo THREADS [DEVICE [PRECISION]]
//                                        steps of the worlds per second of PPO, with all that is learned from them
//
// DEVICE and PRECISION are those of synpo-train; with torch-cpu the same work on the same batch is LibTorch's.
//
// world_steps_per_s and kitchen_steps_per_s are steps of the two worlds, with what the agent sees at each, on one core.
// train_METHOD_states_per_s_b512 is a training step of each method as the fast recipe has it.
// head_FORM_ACTIONS_train and _infer are the bilinear head alone, d = K = 128, 512 states of 144 pairs. `direct`
// composes A d K a pair and scores with A d a state; `general`, with phi(a) of D = 32, composes D d K and scores with D
// d + A D. Training is forward and backward, inference what is left when the pairs are composed.
#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/random.h"
#include "engine/cpu_engine.h"
#include "engine/device.h"
#include "learn/ppo/ppo.h"
#include "learn/recipe.h"
#include "learn/steps.h"
#include "nn/adam.h"
#include "nn/gemm.h"
#include "nn/layers/conv.h"
#include "play/episode.h"
#include "play/model.h"
#include "play/running_episode.h"
#include "play/world_factory.h"
#include "policy/method/registry.h"
#include "policy/method/synpo.h"
#include "world/grid/grid_set.h"
#include "world/grid/view.h"

using namespace synpo;

namespace {

// Random steps of a world; an observation is a picture of the start of an episode, or features drawn at random.
struct RandomBatch {
  std::vector<uint8_t> observations;
  std::vector<int> env, task, label, taken, next;
  std::vector<float> reward, planner_q;
  StepBatch<float> batch;

  RandomBatch(int n, const PolicyShape& shape, size_t observation_size)
      : observations(n * observation_size), env(n), task(n), label(n), taken(n), next(n, StepBatch<float>::kTerminal),
        reward(n), planner_q(size_t(n) * shape.actions, 1.0f) {
    for (int i = 0; i < n; ++i) {
      Random random(1, Purpose::kEpisodeStart, 0, i);
      env[i] = int(random.below(uint32_t(shape.envs)));
      task[i] = int(random.below(uint32_t(shape.tasks)));
      if (random.below(400) < 256) task[i] = (env[i] + int(random.below(7))) % shape.tasks;  // about 144 distinct pairs
      label[i] = int(random.below(uint32_t(shape.actions)));
      taken[i] = label[i];
      reward[i] = -0.01f;
      if (i < n / 2) next[i] = n / 2 + i;
      uint8_t* observation = observations.data() + i * observation_size;
      if (shape.observation.sight == Sight::kPictures)
        draw_start(env[i], random, observation);
      else
        draw_features(shape.observation, random, observation);
    }
    batch = {.size = n,
             .observations = observations.data(),
             .env = env.data(),
             .task = task.data(),
             .label = label.data(),
             .taken = taken.data(),
             .reward = reward.data(),
             .seed = 1,
             .next = next.data(),
             .planner_q = planner_q.data()};
  }

 private:
  static void draw_start(int env, Random& random, uint8_t* picture) {
    const Maze& maze = builtin_mazes()[size_t(env)];
    uint8_t colours[kGridCells];
    const GridState state = grid_reset(maze, random);
    draw_view(maze, state.now, 1, colours);
    for (int cell = 0; cell < kGridCells; ++cell)
      for (int f = 0; f < kHistory; ++f) picture[cell * kHistory + f] = colours[cell];
  }
  static void draw_features(const ObservationSpec& spec, Random& random, uint8_t* observation) {
    std::vector<float> floats(spec.bytes() / sizeof(float), 0.0f);
    const size_t hand = floats.size() - ObservationSpec::kObjectFloats;
    for (size_t j = 0; j < hand; ++j) floats[j] = float(random.uniform());
    floats[hand] = float(random.below(uint32_t(spec.objects)));
    std::memcpy(observation, floats.data(), floats.size() * sizeof(float));
  }
};

// States per second: median over repeats of about half a second each.
template <class Work>
double rate(int states, double limit_s, Work&& work) {
  work();
  std::vector<double> rates;
  const TimePoint start = now();
  while (rates.size() < 3 || seconds_since(start) < limit_s) {
    int done = 0;
    const TimePoint begin = now();
    do work(), done += states;
    while (seconds_since(begin) < 0.5);
    rates.push_back(done / seconds_since(begin));
  }
  std::nth_element(rates.begin(), rates.begin() + rates.size() / 2, rates.end());
  return rates[rates.size() / 2];
}

struct NetworkBench {
  double limit_s = 4;
  std::string method = "synpo", world = "gridworld";
  DeviceOptions device = {};
};

double network_rate(bool train, int n, int threads, const NetworkBench& bench = {}) {
  const auto& [limit_s, method, world, device] = bench;
  Parallel parallel(threads);
  const std::unique_ptr<World> opened = open_world(world);
  const ImitationOptions options = recipe(kDefaultRecipe, method, opened->observation_spec().sight);
  const PolicyShape shape = options.shape(*opened);
  const std::unique_ptr<Policy<float>> made = make_policy(method, shape);
  Policy<float>& policy = *made;
  const std::unique_ptr<Engine> engine = make_engine(device, parallel, method, shape, policy);
  const size_t count = policy.parameters().total();
  Buffer<float> parameters(count), statistics(policy.statistics().total()), m(count), v(count),
      logits(size_t(n) * shape.actions);
  policy.initialise({}, parameters.data(), statistics.data());
  m.zero();
  v.zero();
  const RandomBatch data(n, shape, policy.observation_size());
  int64_t step = 0;
  if (train) {
    engine->take({parameters.data(), statistics.data(), m.data(), v.data()});
    // A GPU records the second update.
    for (int i = 0; i < 2; ++i) engine->update(parallel, data.batch, options.step(), {{}, ++step}, logits.data());
    return rate(n, limit_s, [&] { engine->update(parallel, data.batch, options.step(), {{}, ++step}, logits.data()); });
  }
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < shape.envs * shape.tasks; ++i) pairs.emplace_back(i / shape.tasks, i % shape.tasks);
  std::vector<int> pair(n);
  for (int i = 0; i < n; ++i) pair[i] = data.env[i] * shape.tasks + data.task[i];
  engine->prepare_inference(parallel, parameters.data(), statistics.data(), pairs);
  const int unit = engine->inference_unit();
  return rate(n, limit_s, [&] {
    parallel.run(shard_count(n, unit), [&](int shard, int thread) {
      const Range range = shard_range(n, unit, shard);
      engine->infer(thread, range.size(), data.observations.data() + range.begin * policy.observation_size(),
                    pair.data() + range.begin, logits.data() + size_t(range.begin) * shape.actions);
    });
  });
}

double ppo_rate(int threads, const DeviceOptions& device) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(threads);
  Model model;
  model.method = "synpo";
  model.shape = recipe(kDefaultRecipe).shape(world);
  for (int i = 0; i < 144; ++i) model.seen.push_back({i % 20, (i + 3 * (i / 20)) % 20});
  model.policy = make_policy(model.method, model.shape);
  compute_on(device, parallel, model);
  model.parameters.grow(model.policy->parameters().total());
  model.statistics.grow(model.policy->statistics().total());
  model.policy->initialise({}, model.parameters.data(), model.statistics.data());
  PpoOptions options;
  options.value_warm_up = 0;
  Ppo ppo(world, parallel, std::move(model), options, 1);
  ppo.measure_statistics(4);
  return rate(options.lanes * options.rollout, 8, [&] { ppo.update(); });
}

void row(const char* name, double value, const char* unit) { std::printf("%s\t%.6g\t%s\n", name, value, unit); }

// How a training step at batch n is cut for so many threads, wherever it runs: the part of its work that is done in
// regions of fewer than 8, 16, 32 and 64 shards, how many regions a step has, and the time between them as part of a
// step on one thread.
int shard_rows(int n, int threads) {
  const std::unique_ptr<World> world = open_world("gridworld");
  const ImitationOptions options = recipe(kDefaultRecipe);
  const PolicyShape shape = options.shape(*world);
  const std::unique_ptr<Policy<float>> policy = make_policy("synpo", shape);
  const size_t count = policy->parameters().total();
  Buffer<float> parameters(count), statistics(policy->statistics().total()), m(count), v(count),
      logits(size_t(n) * shape.actions);
  policy->initialise({}, parameters.data(), statistics.data());
  m.zero();
  v.zero();
  const RandomBatch data(n, shape, policy->observation_size());
  CpuEngine engine(*policy);
  engine.take({parameters.data(), statistics.data(), m.data(), v.data()});
  int64_t step = 0;
  const auto measure = [&](int with, std::vector<Parallel::Region>& regions) {
    Parallel parallel(with);
    for (int i = 0; i < 2; ++i) engine.update(parallel, data.batch, options.step(), {{}, ++step}, logits.data());
    parallel.watch([&](const Parallel::Region& region) { regions.push_back(region); });
    constexpr int kSteps = 8;
    const TimePoint start = now();
    for (int i = 0; i < kSteps; ++i) engine.update(parallel, data.batch, options.step(), {{}, ++step}, logits.data());
    return seconds_since(start) / kSteps;
  };
  std::vector<Parallel::Region> one, many;
  double inside_s = 0, work_s = 0;
  const double step_s = measure(1, one);
  for (const Parallel::Region& region : one) inside_s += region.elapsed_s / 8;
  measure(threads, many);
  for (const Parallel::Region& region : many) work_s += region.work_s;
  row("between_regions_on_one_thread", 100 * (1 - inside_s / step_s), "%");
  row("regions_of_a_step", double(many.size()) / 8, "");
  for (const int fewer : {8, 16, 32, 64}) {
    double part_s = 0;
    for (const Parallel::Region& region : many) part_s += region.shards < fewer ? region.work_s : 0;
    row(("work_in_fewer_than_" + std::to_string(fewer) + "_shards").c_str(), 100 * part_s / work_s, "%");
  }
  return 0;
}

// Steps of a world with the network's input made at every one, on one core.
double world_rate(const std::string& name) {
  const std::unique_ptr<World> world = open_world(name);
  std::vector<uint8_t> observation(world->observation_size());
  uint64_t episode = 0;
  return rate(20000, 2, [&] {
    for (int steps = 0; steps < 20000;) {
      const EnvTask pair = {int(episode % world->envs()), int(episode % world->task_count())};
      RunningEpisode running;
      running.start(pair, episode_start(*world, pair, 1, Purpose::kEpisodeStart, int64_t(episode++)));
      WorldStep step = {};
      while (!step.ended()) {
        running.observe(*world, 1, observation.data());
        step = running.step(*world, world->expert(pair, running.now()));
        ++steps;
      }
    }
  });
}

double trajectory_rate() {
  const GridSet world = GridSet::open("gridworld");
  int64_t episode = 0;
  size_t bytes = 0;
  return rate(1000, 2, [&] {
    for (int i = 0; i < 1000; ++i, ++episode)
      bytes += format_trajectory(expert_episode(world, {int(episode % 20), int(episode / 20 % 20)}, 1, episode, 0, 1))
                   .size();
  });
}

// Multiply-adds a second of Eigen's float product on the largest layer's shape, on all threads at once.
double eigen_rate(int threads) {
  constexpr int kRows = 512, kSide = 256;
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Parallel parallel(threads);
  std::vector<Matrix> a(threads, Matrix::Random(kRows, kSide)), b(threads, Matrix::Random(kSide, kSide)),
      c(threads, Matrix(kRows, kSide));
  constexpr int kRepeats = 64;
  return rate(threads * kRepeats, 3,
              [&] {
                parallel.run(threads, [&](int shard, int) {
                  for (int i = 0; i < kRepeats; ++i) c[shard].noalias() = a[shard] * b[shard];
                });
              }) *
         kRows * kSide * kSide;
}

// The same of our own product, the right matrix packed as a weight is.
double product_rate(int threads, double limit_s = 3) {
  constexpr int kRows = 512, kSide = 256;
  Parallel parallel(threads);
  const std::vector<float> values(kRows * kSide, 0.5f);
  std::vector<Packed<float>> b(threads);
  std::vector<std::vector<float>> c(threads, std::vector<float>(kRows * kSide));
  for (Packed<float>& packed : b) packed.pack(Op::kAsIs, kSide, kSide, values.data(), kSide);
  constexpr int kRepeats = 64;
  return rate(threads * kRepeats, limit_s,
              [&] {
                parallel.run(threads, [&](int shard, int) {
                  for (int i = 0; i < kRepeats; ++i)
                    gemm(Op::kAsIs, kRows, values.data(), kSide, b[shard], c[shard].data(), kSide);
                });
              }) *
         kRows * kSide * kSide;
}

// States a second drawn for training as the fast recipe does it: worlds, planner, replay memory and pictures, without
// the network.
double draw_rate(int threads) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(threads);
  const ImitationOptions options = recipe("fast");
  ReplayMemory memory(1000);
  for (int i = 0; i < 1000; ++i) memory.add(replay(world, expert_episode(world, {i % 20, i / 20 % 20}, 1, i, 0, 1)));
  RunningDraw running(world, options.running_options(0, 1), 1);
  Minibatch batch;
  int64_t update = 0;
  return rate(int(options.batch_states), 2, [&] {
    running.draw(memory, parallel, int(options.batch_states), 1, update, batch);
    running.advance(memory, batch.label, update++);
  });
}

// Multiply-adds that one state's training step executes in matrix products: forward, and twice that backward but for
// the input's gradient.
double step_multiply_adds() {
  PolicyShape shape;
  shape.observation = grid_observation_spec();
  const SynPo<float> policy(shape);
  const double recognisers = 2.0 * (shape.basis * shape.hidden + shape.hidden * shape.embedding) +
                             shape.embedding * (shape.envs + shape.tasks);
  const double first_block =
      Conv<float>(kGridSide, ObservationSpec::kChannels, shape.channels[0], 3, 2).multiply_adds() +
      Conv<float>(kGridSide, ObservationSpec::kChannels, shape.channels[0], 1, 2).multiply_adds();
  return 3.0 * (policy.encoder().multiply_adds() + recognisers + shape.feature * shape.basis) - first_block;
}

// The same in the kitchens, whose first convolution multiplies five of its taps and has no gradient of its input.
double kitchen_multiply_adds() {
  const std::unique_ptr<World> world = open_world("kitchen");
  const PolicyShape shape = recipe(kDefaultRecipe, "synpo", Sight::kFeatures).shape(*world);
  const SynPo<float> policy(shape);
  const double first = 5.0 * shape.observation.view * shape.views.channels;
  return 3.0 * (policy.encoder().multiply_adds() + shape.feature * shape.basis) - first;
}

// The work of SynPo's head on the states of some pairs, for any number of actions.
class Head {
 public:
  Head(int actions, int action_embedding, int threads)
      : parallel_(threads), form_(actions, kFeature, kBasis, action_embedding, layout_), parameters_(layout_.total()),
        gradient_(layout_.total()), w_(kPairs * form_.matrix_size()), dw_(kPairs * form_.matrix_size()),
        q_(kStates * form_.columns()), dq_(kStates * form_.columns()), scores_(size_t(kStates) * actions),
        psi_(kStates * kFeature, 0.5f), dpsi_(psi_.size()), coefficients_(kPairs * kBasis, 0.1f),
        dcoefficients_(coefficients_.size()) {
    InitStream stream(1, 1);
    form_.initialise(stream, parameters_.data());
    form_.prepare_inference(parameters_.data());
    compose();
  }
  void compose() { form_.compose(parallel_, kPairs, coefficients_.data(), parameters_.data(), w_.data()); }
  void apply() {
    for_pairs(
        [&](size_t p, size_t i) { form_.apply(w(p), psi_.data() + i * kFeature, q_.data() + i * form_.columns()); });
  }
  void infer() {
    apply();
    for_units([&](int rows, size_t i) {
      form_.infer(rows, q_.data() + i * form_.columns(), scores_.data() + i * form_.actions());
    });
  }
  // The scores stand for their own gradient.
  void train() {
    compose();
    apply();
    for_units([&](int rows, size_t i) {
      form_.scores(rows, q_.data() + i * form_.columns(), parameters_.data(), scores_.data() + i * form_.actions());
    });
    gradient_.zero();
    dw_.zero();
    for_units([&](int rows, size_t i) {
      form_.scores_backward(rows, scores_.data() + i * form_.actions(), parameters_.data(),
                            dq_.data() + i * form_.columns());
    });
    form_.phi_backward(kStates, q_.data(), scores_.data(), gradient_.data());
    for_pairs([&](size_t p, size_t i) {
      form_.apply_backward(w(p), psi_.data() + i * kFeature, dq_.data() + i * form_.columns(),
                           dpsi_.data() + i * kFeature, dw_.data() + p * form_.matrix_size());
    });
    form_.compose_backward(parallel_, kPairs, coefficients_.data(), dw_.data(), parameters_.data(),
                           dcoefficients_.data(), gradient_.data());
  }
  static constexpr int kFeature = 128, kBasis = 128, kStates = 512, kPairs = 144;

 private:
  const float* w(size_t pair) const { return w_.data() + pair * form_.matrix_size(); }
  template <class Body>
  void for_pairs(Body&& body) {
    parallel_.run(kPairs, [&](int p, int) {
      for (size_t i = size_t(p); i < kStates; i += kPairs) body(size_t(p), i);
    });
  }
  template <class Body>
  void for_units(Body&& body) {
    constexpr int kUnit = Policy<float>::kInferenceUnit;
    parallel_.run(kStates / kUnit, [&](int unit, int) { body(kUnit, size_t(unit) * kUnit); });
  }
  Parallel parallel_;
  Layout layout_;
  BilinearForm<float> form_;
  Buffer<float> parameters_, gradient_, w_, dw_, q_, dq_, scores_;
  std::vector<float> psi_, dpsi_, coefficients_, dcoefficients_;
};

void method_rows(int threads) {
  for (const std::string& method : method_names())
    row(("train_" + method + "_states_per_s_b512").c_str(),
        network_rate(true, 512, threads, {.limit_s = 2, .method = method}), "states/s");
  for (const int actions : {5, 100, 1000})
    for (const int action_embedding : {0, 32}) {
      Head head(actions, action_embedding, threads);
      const std::string name =
          std::string("head_") + (action_embedding ? "general_" : "direct_") + std::to_string(actions);
      row((name + "_train").c_str(), rate(Head::kStates, 1, [&] { head.train(); }), "states/s");
      row((name + "_infer").c_str(), rate(Head::kStates, 1, [&] { head.infer(); }), "states/s");
    }
}

// A row of rates on one thread and on all, measured in turns: a machine's speed drifts. Returns the gain.
template <class Rate>
double scaling_row(const char* name, int threads, double product_gain, Rate&& rate_on) {
  constexpr int kRounds = 3;
  double one[kRounds], all[kRounds];
  for (int i = 0; i < kRounds; ++i) {
    one[i] = rate_on(1);
    all[i] = rate_on(threads);
  }
  std::sort(one, one + kRounds);
  std::sort(all, all + kRounds);
  const double gain = all[kRounds / 2] / one[kRounds / 2];
  std::printf("%s\t%.6g\t%.6g\t%.2f\t%.2f\n", name, one[kRounds / 2], all[kRounds / 2], gain,
              product_gain > 0 ? gain / product_gain : 1);
  std::fflush(stdout);
  return gain;
}

int scaling(int threads) {
  std::printf("name\tone\tall\tgain\tof_product\n");
  const double gain = scaling_row("product_gflops", threads, 0, [](int t) { return 2e-9 * product_rate(t, 1); });
  for (const int batch : {512, 1600})
    scaling_row(("train_states_per_s_b" + std::to_string(batch)).c_str(), threads, gain,
                [&](int t) { return network_rate(true, batch, t, {.limit_s = 2}); });
  scaling_row("forward_states_per_s_b1600", threads, gain,
              [](int t) { return network_rate(false, 1600, t, {.limit_s = 2}); });
  return 0;
}

int rows() {
  const int threads = Parallel().threads();
  row("world_steps_per_s", world_rate("gridworld"), "steps/s");
  row("kitchen_steps_per_s", world_rate("kitchen"), "steps/s");
  row("trajectories_per_s", trajectory_rate(), "trajectories/s");
  const std::string chosen = kernel_target();
  for (const NamedKernels<float>& target : all_kernels<float>()) {
    choose_kernels(target.name);
    row(("train_" + target.name + "_states_per_s_b512").c_str(), network_rate(true, 512, threads), "states/s");
    row(("product_" + target.name + "_gflops").c_str(), 2e-9 * product_rate(threads), "GFLOP/s");
  }
  choose_kernels(chosen);
  row("eigen_gflops", 2e-9 * eigen_rate(threads), "GFLOP/s");
  for (const int batch : {256, 512, 1024, 4096})
    row(("train_states_per_s_b" + std::to_string(batch)).c_str(), network_rate(true, batch, threads), "states/s");
  const double step = network_rate(true, 512, threads), product = product_rate(threads), drawn = draw_rate(threads);
  row("step_gflops", 2e-9 * step * step_multiply_adds(), "GFLOP/s");
  row("step_of_product", step * step_multiply_adds() / product, "ratio");
  const double kitchen = network_rate(true, 512, threads, {.world = "kitchen"});
  row("kitchen_step_of_product", kitchen * kitchen_multiply_adds() / product, "ratio");
  row("draw_states_per_s", drawn, "states/s");
  row("draw_of_step", step / drawn, "ratio");
  method_rows(threads);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const auto device_at = [&](int at) {
    DeviceOptions device;
    if (argc > at) device.device = argv[at];
    if (argc > at + 1) device.precision = argv[at + 1];
    return device;
  };
  if (argc >= 4 && argc <= 6 && (what == "train" || what == "forward" || what == "kitchen")) {
    NetworkBench bench;
    if (what == "kitchen") bench.world = "kitchen";
    bench.device = device_at(4);
    if (bench.device.device.starts_with("cuda")) bench.limit_s = 2;  // steadier than a CPU
    std::stringstream batches(argv[2]);
    for (std::string batch; std::getline(batches, batch, ',');) {
      std::printf("%.0f\n", network_rate(what != "forward", std::atoi(batch.c_str()), std::atoi(argv[3]), bench));
      std::fflush(stdout);
    }
    return 0;
  }
  if (argc == 3 && what == "scaling") return scaling(std::atoi(argv[2]));
  if (argc == 4 && what == "shards") return shard_rows(std::atoi(argv[2]), std::atoi(argv[3]));
  if (argc >= 3 && argc <= 5 && what == "ppo") {
    std::printf("%.0f\n", ppo_rate(std::atoi(argv[2]), device_at(3)));
    return 0;
  }
  if (argc == 2 && what == "rows") return rows();
  if (argc == 2 && what == "methods") {
    method_rows(Parallel().threads());
    return 0;
  }
  std::fputs(
      "usage: synpo-bench rows | methods | train|forward|kitchen BATCH[,BATCH...] THREADS [DEVICE [PRECISION]] |\n"
      "       shards BATCH THREADS | scaling THREADS | ppo THREADS [DEVICE [PRECISION]]\n",
      stderr);
  return 64;
}
