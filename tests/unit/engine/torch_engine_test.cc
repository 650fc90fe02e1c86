// LibTorch's engine against the CPU's: losses, scores, gradients, updates, of every method and both sights. Where there
// is no plug-in (make torch) the tests are skipped; SYNPO_TEST_DEVICE and SYNPO_TEST_PRECISION choose another device.
#include "engine/torch_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "engine/cpu_engine.h"
#include "engine/device.h"
#include "helpers/policy_fixture.h"
#include "kernel/kernels.h"
#include "learn/recipe.h"
#include "nn/init.h"
#include "nn/softmax.h"
#include "play/world_factory.h"

namespace synpo {
namespace {

std::string from_environment(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

DeviceOptions device() {
  return {from_environment("SYNPO_TEST_DEVICE", "torch-cpu"), from_environment("SYNPO_TEST_PRECISION", "float32")};
}

// Whether products are rounded to less than float32: LibTorch's, or the CPU's (kernel/kernels.h).
bool coarse() { return device().precision != "float32" || kernels<float>().product_error > 0x1p-24; }

// What two computations may differ by: in float32 every tensor, relative to its length; in coarser precisions, where
// many a ReLU changes its sign, scores and the gradient as a whole.
double limit() { return 1e-4; }
double scores_limit() { return !coarse() ? limit() : device().precision == "bf16" ? 5e-2 : 5e-3; }
double gradient_limit() { return !coarse() ? limit() : device().precision == "bf16" ? 0.35 : 0.1; }

struct Case {
  const char* name;
  const char* method;
  bool features;
  int action_embedding = 0;
  SfLoss sf_loss = SfLoss::kTemporalDifference;
  bool normalise = false;
  bool full = false;  // as wide as the paper's
};

void PrintTo(const Case& c, std::ostream* to) { *to << c.name; }

PolicyShape shape_of(const Case& c) {
  if (c.full) {
    PolicyShape shape =
        c.features ? recipe("paper", c.method, Sight::kFeatures).shape(*open_world("kitchen")) : paper_shape();
    shape.sf_loss = c.sf_loss;
    return shape;
  }
  PolicyShape shape = c.features ? tiny_feature_shape() : tiny_shape(c.normalise);
  if (!c.features) shape.channels = {8, 8, 16, 16};
  shape.basis = 40;
  shape.embedding = 24;
  if (coarse()) {  // in a wide network what single signs change is little
    const PolicyShape wide = paper_shape();
    shape.channels = wide.channels;
    shape.feature = wide.feature;
    shape.hidden = wide.hidden;
    shape.head_hidden = shape.basis = shape.embedding = 128;
    if (c.features) shape.views = {64, 8, 128};
  }
  shape.action_embedding = c.action_embedding;
  shape.sf_loss = c.sf_loss;
  return shape;
}

const StepOptions kOptions = {{0.3, 0.2, 0.1}, 0.4, 0.9};

// Whether the step's gradient would hardly change if everything were computed a little differently. It does change
// where the input of a ReLU is so near zero that rounding gives it another sign.
bool steady(const PolicyShape& shape, const std::string& method, const std::vector<float>& parameters, int size,
            uint64_t seed, bool frozen) {
  Network<double> net(shape, method);
  net.initialise();
  const RandomSteps<double> steps(size, shape, seed);
  StepBatch<double> batch = steps.batch();
  batch.frozen_statistics = frozen;
  Parallel parallel(1);
  const std::vector<double> statistics = net.statistics;
  std::vector<double> before;
  for (uint64_t trial = 0; trial < 5; ++trial) {
    const std::vector<double> noise = random_values<double>(parameters.size(), 100 + trial);
    for (size_t i = 0; i < parameters.size(); ++i)
      net.parameters[i] = parameters[i] * (1 + (trial > 0 ? 3e-6 * noise[i] : 0));
    net.statistics = statistics;
    net.step(parallel, batch, kOptions);
    if (trial == 0) before = net.gradient;
    for (const TensorInfo& tensor : net.policy->parameters().tensors())
      if (relative_error(net.gradient.data() + tensor.offset, before.data() + tensor.offset, tensor.size) >
          0.5 * limit())
        return false;
  }
  return true;
}

// Two networks of the same weights. One thread where they are small: oneDNN 2.6, Debian's, writes past its memory in
// the gradient of a convolution of 8 channels with AVX-512 and two threads.
class TorchEngine : public testing::TestWithParam<Case> {
 protected:
  const int size_ = coarse() ? 256 : GetParam().full ? 4 : 12;  // of a batch
  TorchEngine() : shape(shape_of(GetParam())), net(shape, GetParam().method), parallel(coarse() ? 0 : 1) {
    net.initialise();
    net.shake();
    other_gradient.assign(net.gradient.size(), 7);  // which is overwritten
    logits.assign(size_t(size_) * shape.actions, 0);
    other_logits = logits;
  }
  void SetUp() override {
    try {
      torch = make_engine(device(), parallel, GetParam().method, shape, *net.policy);
    } catch (const Error& error) {
      if (!error.has(kNoPlugin)) throw;
      GTEST_SKIP() << error.what();
    }
  }

  RandomSteps<float> draw_steps(const std::vector<float>& parameters, int size, bool frozen, uint64_t first = 1) const {
    for (uint64_t seed = first; seed < first + 400; ++seed)
      if (coarse() || steady(shape, GetParam().method, parameters, size, seed, frozen)) return {size, shape, seed};
    ADD_FAILURE() << "no batch is steady";
    return {size, shape, first};
  }

  double worst_tensor(const Layout& layout, const float* got, const float* want) const {
    double worst = 0;
    for (const TensorInfo& tensor : layout.tensors()) {
      const double error = relative_error(got + tensor.offset, want + tensor.offset, tensor.size);
      if (!coarse()) {
        EXPECT_LT(error, limit()) << tensor.name;
      }
      worst = std::max(worst, error);
    }
    EXPECT_LT(relative_error(got, want, layout.total()), gradient_limit());
    return worst;
  }
  void expect_same(const Losses& got, const Losses& want) const {
    for (double Losses::*loss : {&Losses::total, &Losses::policy, &Losses::reward, &Losses::env, &Losses::task}) {
      ASSERT_EQ(std::isnan(got.*loss), std::isnan(want.*loss));
      if (!std::isnan(want.*loss)) {
        EXPECT_LT(std::abs(got.*loss - want.*loss), scores_limit() * (1e-2 + std::abs(want.*loss)));
      }
    }
  }
  // One step of both engines; notes how far they are apart.
  void compare_steps(const StepBatch<float>& batch) {
    std::vector<float> other_statistics = net.statistics;
    CpuEngine cpu(*net.policy);
    const Losses want = cpu.step(parallel, batch, kOptions, net.parameters.data(), net.statistics.data(),
                                 net.gradient.data(), logits.data());
    const Losses got = torch->step(parallel, batch, kOptions, net.parameters.data(), other_statistics.data(),
                                   other_gradient.data(), other_logits.data());
    expect_same(got, want);
    const double scores = relative_error(other_logits, logits),
                 gradient = worst_tensor(net.policy->parameters(), other_gradient.data(), net.gradient.data());
    EXPECT_LT(scores, scores_limit());
    worst_tensor(net.policy->statistics(), other_statistics.data(), net.statistics.data());
    Errors& worst = worst_[GetParam().name];
    worst.loss = std::max(worst.loss, std::abs(got.total - want.total) / std::abs(want.total));
    worst.scores = std::max(worst.scores, scores);
    worst.gradient = std::max(worst.gradient, gradient);
  }
  // The worst of every case.
  static void TearDownTestSuite() {
    for (const auto& [name, errors] : worst_)
      std::printf("  %-18s loss %.1e  logits %.1e  worst gradient %.1e\n", name.c_str(), errors.loss, errors.scores,
                  errors.gradient);
    worst_.clear();
  }

  PolicyShape shape;
  Network<float> net;
  Parallel parallel;
  std::unique_ptr<Engine> torch;
  std::vector<float> other_gradient, logits, other_logits;

 private:
  struct Errors {
    double loss = 0, scores = 0, gradient = 0;
  };
  static inline std::map<std::string, Errors> worst_;  // by the case's name
};

INSTANTIATE_TEST_SUITE_P(Every, TorchEngine,
                         testing::Values(Case{"synpo", "synpo", false}, Case{"general", "synpo", false, 3},
                                         Case{"normalised", "synpo", false, 0, SfLoss::kTemporalDifference, true},
                                         Case{"mtl", "mtl", false}, Case{"mlp", "mlp", false},
                                         Case{"modulenet", "modulenet", false}, Case{"sf_td", "sf", false},
                                         Case{"sf_q", "sf", false, 0, SfLoss::kPlannerQ},
                                         Case{"sf_ce", "sf", false, 0, SfLoss::kCrossEntropy},
                                         Case{"kitchen", "synpo", true}, Case{"kitchen_mlp", "mlp", true},
                                         Case{"kitchen_sf", "sf", true}),
                         [](const auto& info) { return info.param.name; });

TEST_P(TorchEngine, AgreesOnLossesScoresAndGradients) {
  const RandomSteps<float> steps = draw_steps(net.parameters, size_, false);
  compare_steps(steps.batch());
}

// The networks of both worlds as wide as the paper's, where sums are long.
class TorchEngineFullWidth : public TorchEngine {
 protected:
  void SetUp() override {
    if (coarse()) GTEST_SKIP() << "every network is wide where products are coarse";
    TorchEngine::SetUp();
  }
};

Case full(const char* name, const char* method, bool features, SfLoss sf_loss = SfLoss::kTemporalDifference) {
  return {name, method, features, 0, sf_loss, false, true};
}
INSTANTIATE_TEST_SUITE_P(Every, TorchEngineFullWidth,
                         testing::Values(full("full_synpo", "synpo", false), full("full_mtl", "mtl", false),
                                         full("full_mlp", "mlp", false), full("full_modulenet", "modulenet", false),
                                         full("full_sf", "sf", false, SfLoss::kCrossEntropy),
                                         full("full_kitchen", "synpo", true), full("full_kitchen_mlp", "mlp", true)),
                         [](const auto& info) { return info.param.name; });

TEST_P(TorchEngineFullWidth, AgreesOnLossesScoresAndGradients) {
  const RandomSteps<float> steps = draw_steps(net.parameters, size_, false);
  compare_steps(steps.batch());
}

TEST_P(TorchEngine, AgreesWithFrozenStatistics) {
  const RandomSteps<float> steps = draw_steps(net.parameters, size_, true);
  StepBatch<float> batch = steps.batch();
  batch.frozen_statistics = true;
  compare_steps(batch);
}

TEST_P(TorchEngine, AgreesWhereTheFeatureIsGiven) {
  const RandomSteps<float> steps(size_, shape, 1);
  const std::vector<float> psi = random_values<float>(size_t(size_) * shape.feature, 9);
  StepBatch<float> batch = steps.batch();
  batch.observations = nullptr;
  batch.psi = psi.data();
  compare_steps(batch);
}

// A minibatch of PPO: two engines from the same arrays, the next one with the policy's rate changed. RMSProp divides a
// gradient by its own size, so that a value that is nearly nothing may go anywhere: epsilon is large enough to see
// differences in gradients instead.
TEST_P(TorchEngine, AgreesOnPpo) {
  const RandomSteps<float> steps = draw_steps(net.parameters, size_, true);
  PpoUpdate update;
  update.auxiliary = kOptions.weights;
  update.clipping = {0.2, 0.05};
  update.value_weight = 0.7;
  update.gradient_norm = 0.9;
  update.policy = update.value = {0.0002, 0.9, 0.1, 0.01};
  update.value.learning_rate = 0.001;

  ValueFunction value(shape, *net.policy, 16);
  std::vector<float> value_start(value.parameters().total());
  InitStream stream(5, 2);
  value.initialise(stream, value_start.data());
  const std::vector<float> zeros(net.parameters.size(), 0), value_zeros(value_start.size(), 0);
  struct Arrays {
    std::vector<float> parameters, statistics, squares, value, value_squares;
    PpoArrays pointers() {
      return {parameters.data(), statistics.data(), squares.data(), value.data(), value_squares.data()};
    }
  };
  const Arrays start = {net.parameters, net.statistics, zeros, value_start, value_zeros};
  Arrays want = start, got = start;
  CpuEngine cpu(*net.policy);
  cpu.take_ppo(value, want.pointers());
  torch->take_ppo(value, got.pointers());

  // Ratios on both sides of the bounds, by old probabilities near the policy's own.
  const std::vector<float> scores = net.infer(parallel, steps.batch(), 32);
  double size_of_scores = 1;
  for (const float score : scores) size_of_scores = std::max(size_of_scores, std::abs(double(score)));
  std::vector<float> old, target = random_values<float>(size_t(size_), 8),
                          advantage = random_values<float>(size_t(size_), 7);
  for (int i = 0; i < size_; ++i) {
    std::vector<double> p(size_t(shape.actions));
    const float* row = scores.data() + i * shape.actions;
    const double log_sum = softmax(row, shape.actions, 1, p.data());
    old.push_back(float(row[steps.taken[size_t(i)]] - log_sum + 0.15 * (i % 5 - 2)));
  }
  const PpoBatch batch = {steps.batch(), shape.actions, old.data(), advantage.data(), target.data()};
  for (const double rate : {0.0002, 0.0, 0.0001}) {
    update.policy.learning_rate = rate;
    const PpoLosses a = cpu.update_ppo(parallel, batch, update), b = torch->update_ppo(parallel, batch, update);
    EXPECT_GT(a.clip_fraction, 0);
    EXPECT_LT(a.clip_fraction, 1);
    // Ratios are off by as much as scores are, which is relative to those; later the networks have gone their own ways.
    const double near = rate == 0.0002 ? scores_limit() * size_of_scores : 0.05;
    using Loss = double PpoLosses::*;
    for (const Loss loss : std::vector<Loss>{&PpoLosses::policy, &PpoLosses::entropy, &PpoLosses::largest_ratio,
                                             &PpoLosses::smallest_ratio, &PpoLosses::value, &PpoLosses::total})
      EXPECT_NEAR(b.*loss, a.*loss, near * (0.1 + std::abs(a.*loss)));
    EXPECT_NEAR(b.kl, a.kl, 2 * near * (0.1 + std::abs(a.kl)));
    if (rate != 0.0002) continue;
    EXPECT_NEAR(b.clip_fraction, a.clip_fraction, coarse() ? 0.05 : 1e-6);
    EXPECT_EQ(got.parameters, start.parameters) << "not given back yet";
    torch->give_back();
    const auto expect_moved = [&](std::vector<float> Arrays::*array) {
      std::vector<double> way, gone;
      for (size_t i = 0; i < (want.*array).size(); ++i) {
        way.push_back(double((want.*array)[i]) - (start.*array)[i]);
        gone.push_back(double((got.*array)[i]) - (start.*array)[i]);
      }
      EXPECT_LT(relative_error(gone, way), gradient_limit());
    };
    for (std::vector<float> Arrays::*array :
         {&Arrays::parameters, &Arrays::squares, &Arrays::value, &Arrays::value_squares})
      expect_moved(array);
  }
  torch->give_back();
  EXPECT_EQ(got.statistics, start.statistics);
}

TEST_P(TorchEngine, ScoresAStateTheSameInEveryCompany) {
  const int count = std::min(size_, torch->inference_unit());
  const RandomSteps<float> steps(count, shape, 1);
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) {
    pairs.emplace_back(steps.env[size_t(i)], steps.task[size_t(i)]);
    numbers.push_back(i);
  }
  const std::vector<float> want = net.infer(parallel, steps.batch(), 32);
  other_logits.resize(want.size());
  torch->prepare_inference(parallel, net.parameters.data(), net.statistics.data(), pairs);
  std::vector<float> psi(size_t(count) * shape.feature);
  torch->infer(0, count, steps.observations.data(), numbers.data(), other_logits.data(), psi.data());
  EXPECT_LT(relative_error(other_logits, want), scores_limit());
  std::vector<float> alone(size_t(shape.actions));
  for (const int i : {0, 5, count - 1}) {
    torch->infer(0, 1, steps.observations.data() + size_t(i) * net.policy->observation_size(), &i, alone.data());
    const std::vector<float> together(other_logits.begin() + i * shape.actions,
                                      other_logits.begin() + (i + 1) * shape.actions);
    if (device().device == "torch-cpu")  // whose library treats the last rows of a product in another way
      EXPECT_LT(relative_error(alone, together), coarse() ? 0.01 : 1e-5);
    else
      EXPECT_EQ(alone, together);
  }
}

// A training: the arrays move with the engine, and come back when asked for; a GPU replays the third update. On the way
// a ReLU may get another sign: how far everything has moved is compared, not to the last digits.
TEST_P(TorchEngine, AgreesAfterSomeUpdates) {
  if (coarse()) GTEST_SKIP() << "what single signs change grows from update to update";
  struct Arrays {
    std::vector<float> parameters, statistics, m, v, average, average_statistics;
    TrainingArrays pointers() {
      return {parameters.data(), statistics.data(), m.data(), v.data(), average.data(), average_statistics.data()};
    }
  };
  const std::vector<float> zeros(net.parameters.size(), 0);
  const Arrays start = {net.parameters, net.statistics, zeros, zeros, net.parameters, net.statistics};
  Arrays want = start, got = start;
  CpuEngine cpu(*net.policy);
  cpu.take(want.pointers());
  torch->take(got.pointers());
  for (int64_t step = 1; step <= 5; ++step) {
    const RandomSteps<float> drawn = draw_steps(want.parameters, step < 4 ? size_ : 9, false, uint64_t(1000 * step));
    AdamUpdate adam;
    adam.options = {1e-2 * double(step), 0.9, 0.99, 0.1, 0.01};
    adam.step = step;
    adam.keep = 0.5 + 0.1 * double(step);
    const Losses a = cpu.update(parallel, drawn.batch(uint64_t(step)), kOptions, adam, logits.data());
    const Losses b = torch->update(parallel, drawn.batch(uint64_t(step)), kOptions, adam, other_logits.data());
    if (step == 1) expect_same(b, a);
    EXPECT_NEAR(b.total, a.total, 0.02 * std::abs(a.total));
    if (step == 2) {
      EXPECT_EQ(got.parameters, start.parameters) << "not given back yet";
    }
  }
  torch->give_back();
  for (std::vector<float> Arrays::*array : {&Arrays::parameters, &Arrays::statistics, &Arrays::m, &Arrays::v,
                                            &Arrays::average, &Arrays::average_statistics}) {
    std::vector<double> way, gone;
    for (size_t i = 0; i < (want.*array).size(); ++i) {
      way.push_back(double((want.*array)[i]) - (start.*array)[i]);
      gone.push_back(double((got.*array)[i]) - (start.*array)[i]);
    }
    EXPECT_LT(relative_error(gone, way), 0.1);
  }
}

}  // namespace
}  // namespace synpo
