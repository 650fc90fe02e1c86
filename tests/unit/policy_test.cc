#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

#include "format/safetensors.h"
#include "nn/adam.h"
#include "numbers.h"
#include "targets.h"
#include "policy/synpo.h"
#include "temporary.h"
#include "world/view.h"

namespace synpo {
namespace {

constexpr size_t kPicture = size_t(kGridCells) * kHistory;

// Steps with everything drawn at random.
template <class T>
struct RandomSteps {
  RandomSteps(int size, const PolicyShape& shape, uint64_t seed) : pictures(size * kPicture), reward(random_values<T>(size, seed)) {
    Random random(seed, Purpose::kBatch);
    for (uint8_t& colour : pictures) colour = uint8_t(random.below(kGridColours));
    for (int i = 0; i < size; ++i) {
      env.push_back(int(random.below(uint32_t(shape.envs))));
      task.push_back(int(random.below(uint32_t(shape.tasks))));
      label.push_back(int(random.below(uint32_t(shape.actions))));
      taken.push_back(int(random.below(uint32_t(shape.actions))));
    }
  }
  StepBatch<T> batch() const {
    return {int(env.size()), pictures.data(), env.data(), task.data(), label.data(), taken.data(), reward.data()};
  }
  std::vector<uint8_t> pictures;
  std::vector<int> env, task, label, taken;
  std::vector<T> reward;
};

// A policy's arrays, and a step over them.
template <class T>
struct Network {
  explicit Network(const PolicyShape& shape)
      : policy(shape), parameters(policy.parameters().total(), T(0)), statistics(policy.statistics().total(), T(0)),
        gradient(parameters.size(), T(0)) {}
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights) {
    logits.assign(size_t(batch.size) * 5, T(0));
    return policy.step(parallel, batch, weights, parameters.data(), statistics.data(), gradient.data(), logits.data());
  }
  // Each state's scores, of the pairs as they stand in the batch.
  std::vector<T> infer(Parallel& parallel, const StepBatch<T>& batch, int at_once) {
    std::vector<std::pair<int, int>> pairs;
    std::vector<int> numbers;
    for (int i = 0; i < batch.size; ++i) {
      pairs.emplace_back(batch.env[i], batch.task[i]);
      numbers.push_back(i);
    }
    policy.prepare_inference(parallel, parameters.data(), statistics.data(), pairs);
    std::vector<T> scores(size_t(batch.size) * 5);
    const int shards = shard_count(batch.size, at_once);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(batch.size, at_once, shard);
      policy.infer(thread, range.size(), batch.pictures + range.begin * kPicture, numbers.data() + range.begin, scores.data() + range.begin * 5);
    });
    return scores;
  }
  SynPo<T> policy;
  std::vector<T> parameters, statistics, gradient, logits;
};

PolicyShape tiny_shape(bool normalise) {
  PolicyShape shape;
  shape.channels = {4, 5, 4, 6};
  shape.envs = 3;
  shape.tasks = 4;
  shape.feature = 6;
  shape.basis = 5;
  shape.embedding = 4;
  shape.hidden = 7;
  shape.normalise_input = shape.normalise_embeddings = normalise;
  return shape;
}

class SynPoGradient : public testing::TestWithParam<bool> {};

TEST_P(SynPoGradient, IsFiniteDifferences) {
  const PolicyShape shape = tiny_shape(GetParam());
  Network<double> net(shape);
  net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
  const std::vector<double> shake = random_values<double>(net.parameters.size(), 8);
  for (const TensorInfo& tensor : net.policy.parameters().tensors())
    for (size_t i = tensor.offset; i < tensor.offset + tensor.size; ++i) net.parameters[i] += 0.2 * shake[i];
  const RandomSteps<double> steps(9, shape, 4);
  const LossWeights weights = {0.3, 0.5, 0.7};
  Parallel parallel(1);
  const std::vector<double> statistics = net.statistics;
  const auto loss = [&] {
    net.statistics = statistics;
    return net.step(parallel, steps.batch(), weights).total;
  };
  const double here = loss();
  const std::vector<double> gradient = net.gradient;
  // A ReLU that changes sign within the step would bend the loss: the slopes to both sides then differ by a part of the gradient, where
  // without they differ by the step times the curvature. The step is so small that none does, and the slopes are held to that.
  constexpr double kStep = 1e-7;
  Random random(1, Purpose::kInit, 9);
  for (const TensorInfo& tensor : net.policy.parameters().tensors()) {
    double norm = 0;
    for (size_t i = 0; i < tensor.size; ++i) norm += std::pow(gradient[tensor.offset + i], 2) / tensor.size;
    norm = std::sqrt(norm);
    EXPECT_GT(norm, 1e-6) << tensor.name;
    for (int draw = 0; draw < 8; ++draw) {
      const size_t at = tensor.offset + random.below(uint32_t(tensor.size));
      const double kept = net.parameters[at];
      net.parameters[at] = kept + kStep;
      const double right = (loss() - here) / kStep;
      net.parameters[at] = kept - kStep;
      const double left = (here - loss()) / kStep;
      net.parameters[at] = kept;
      ASSERT_NEAR(left, right, 1e-3 * (norm + std::abs(gradient[at]))) << tensor.name << ": a ReLU near zero? take another seed";
      ASSERT_NEAR(gradient[at], (left + right) / 2, 1e-5 * (norm + std::abs(gradient[at]))) << tensor.name << " at " << at - tensor.offset;
    }
  }
}

TEST_P(SynPoGradient, EveryLossCountsByItsWeight) {
  const PolicyShape shape = tiny_shape(GetParam());
  Network<double> net(shape);
  net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
  const RandomSteps<double> steps(9, shape, 4);
  Parallel parallel(1);
  const std::vector<double> statistics = net.statistics;
  const auto gradient = [&](const LossWeights& weights) {
    net.statistics = statistics;
    const Losses losses = net.step(parallel, steps.batch(), weights);
    EXPECT_NEAR(losses.total, losses.policy + weights.reward * losses.reward + weights.env * losses.env + weights.task * losses.task, 1e-13);
    return net.gradient;
  };
  const std::vector<double> none = gradient({0, 0, 0});
  std::vector<double> sum = none;
  for (const LossWeights& weights : {LossWeights{2, 0, 0}, LossWeights{0, 3, 0}, LossWeights{0, 0, 4}}) {
    const std::vector<double> one = gradient(weights);
    EXPECT_GT(relative_error(one, none), 1e-3);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += one[i] - none[i];
  }
  EXPECT_LT(relative_error(gradient({2, 3, 4}), sum), 1e-12);
}

std::string on_or_off(const testing::TestParamInfo<bool>& info) { return info.param ? "Normalised" : "Plain"; }
INSTANTIATE_TEST_SUITE_P(Normalise, SynPoGradient, testing::Bool(), on_or_off);

// The worst relative error of each kind of result, over its tensors.
class Worst {
 public:
  void add(const std::string& kind, const std::string& name, double error, double limit = 1e-4) {
    EXPECT_LT(error, limit) << kind << " " << name;
    auto& [worst, where] = worst_[kind];
    if (!(error <= worst)) {
      worst = error;
      where = name;
    }
  }
  void print() const {
    for (const auto& [kind, worst] : worst_) std::printf("%-12s %.2e  %s\n", kind.c_str(), worst.first, worst.second.c_str());
  }

 private:
  std::map<std::string, std::pair<double, std::string>> worst_;
};

PolicyShape shape_of(const SafeTensors& dump) {
  const auto size = [&](const char* name) { return std::atoi(dump.meta(name).c_str()); };
  PolicyShape shape;
  const std::string& channels = dump.meta("channels");
  EXPECT_EQ(std::sscanf(channels.c_str(), "%d,%d,%d,%d", &shape.channels[0], &shape.channels[1], &shape.channels[2], &shape.channels[3]), 4);
  shape.envs = size("envs");
  shape.tasks = size("tasks");
  shape.feature = size("feature");
  shape.basis = size("basis");
  shape.embedding = size("embedding");
  shape.hidden = size("hidden");
  return shape;
}

// The dump's [n, 16, 16, 3 * history] of pixel values as colour indices [n, 16, 16, history].
std::vector<uint8_t> colour_indices(const std::vector<uint8_t>& pixels) {
  std::map<int, uint8_t> index;
  for (int i = 0; i < kGridColours; ++i) index[kPalette[i].r << 16 | kPalette[i].g << 8 | kPalette[i].b] = uint8_t(i);
  std::vector<uint8_t> colours(pixels.size() / 3);
  for (size_t i = 0; i < colours.size(); ++i) {
    const auto found = index.find(pixels[3 * i] << 16 | pixels[3 * i + 1] << 8 | pixels[3 * i + 2]);
    if (found == index.end()) {
      ADD_FAILURE() << "a colour that the palette does not have";
      return colours;
    }
    colours[i] = found->second;
  }
  return colours;
}

std::vector<int> whole_numbers(const SafeTensors& dump, const char* name) {
  const std::vector<int64_t> values = dump.get<int64_t>(name);
  return {values.begin(), values.end()};
}

// One training step and what follows it, against the results of scripts/torch_reference.py in the file.
Worst compare_with_dump(const std::string& path) {
  Worst worst;
  Input input(path);
  const SafeTensors dump = read_safetensors(input);
  const PolicyShape shape = shape_of(dump);
  Network<float> net(shape);
  const Layout& layout = net.policy.parameters();
  size_t tensors = 0;
  for (const auto& [name, tensor] : dump.tensors) tensors += name.starts_with("param.");
  EXPECT_EQ(tensors, layout.tensors().size());
  for (const TensorInfo& tensor : layout.tensors()) {
    dump.get("param." + tensor.name, net.parameters.data() + tensor.offset, tensor.size);
    EXPECT_EQ(dump.tensors.at("param." + tensor.name).shape, std::vector<int64_t>(tensor.shape.begin(), tensor.shape.end())) << tensor.name;
  }
  for (const TensorInfo& tensor : net.policy.statistics().tensors())
    std::fill_n(net.statistics.data() + tensor.offset, tensor.size, tensor.name.ends_with(".variance") ? 1.0f : 0.0f);
  const std::vector<uint8_t> pictures = colour_indices(dump.get<uint8_t>("input"));
  const std::vector<int> env = whole_numbers(dump, "env"), task = whole_numbers(dump, "task"), label = whole_numbers(dump, "label"),
                         taken = whole_numbers(dump, "taken");
  const std::vector<float> reward = dump.get<float>("reward");
  const StepBatch<float> batch = {int(env.size()), pictures.data(), env.data(), task.data(), label.data(), taken.data(), reward.data()};
  const auto number = [&](const char* name) { return std::atof(dump.meta(name).c_str()); };
  // No input of a ReLU in the file is so near zero that a float's rounding changes its sign. Coarser products do change some, and gradients with
  // them: of those, only what stands before the gradients is compared.
  const bool coarse = kernels<float>().product_error > 0x1p-24;
  const double limit = coarse ? 10 * kernels<float>().product_error : 1e-4;
  const auto compare = [&](const std::string& kind, const std::string& name, const float* got) {
    const std::vector<float> want = dump.get<float>(name);
    worst.add(kind, name, relative_error(got, want.data(), want.size()), limit);
  };

  Parallel parallel(1);
  const Losses losses = net.step(parallel, batch, {number("weight_reward"), number("weight_env"), number("weight_task")});
  const double got[5] = {losses.total, losses.policy, losses.reward, losses.env, losses.task};
  const std::vector<double> want = dump.get<double>("loss");
  for (int i = 0; i < 5; ++i) worst.add("loss", "number " + std::to_string(i), relative_error(got + i, want.data() + i, 1), limit);
  compare("logits", "logits", net.logits.data());
  compare("psi", "psi", net.policy.last_feature());
  if (coarse) return worst;
  for (const TensorInfo& tensor : layout.tensors()) compare("gradient", "grad." + tensor.name, net.gradient.data() + tensor.offset);
  for (const TensorInfo& tensor : net.policy.statistics().tensors()) compare("statistics", "after." + tensor.name, net.statistics.data() + tensor.offset);
  const std::vector<float> scores = net.infer(parallel, batch, SynPo<float>::kInferenceUnit);
  compare("inference", "eval_logits", scores.data());

  const std::vector<float> before = net.parameters;
  std::vector<float> m(net.parameters.size(), 0), v(net.parameters.size(), 0);
  AdamOptions adam;
  adam.learning_rate = number("learning_rate");
  adam.weight_decay = number("weight_decay");
  adam_step(parallel, adam, 1, layout.total(), net.gradient.data(), net.parameters.data(), m.data(), v.data());
  size_t moved = 0;
  for (const TensorInfo& tensor : layout.tensors()) {
    if (!dump.has("adam." + tensor.name)) continue;
    ++moved;
    compare("adam", "adam." + tensor.name, net.parameters.data() + tensor.offset);
    // The way that was gone, which is small beside where it leads: float parameters know it to some four digits.
    std::vector<float> way = dump.get<float>("adam." + tensor.name), gone(tensor.size);
    for (size_t i = 0; i < tensor.size; ++i) {
      way[i] -= before[tensor.offset + i];
      gone[i] = net.parameters[tensor.offset + i] - before[tensor.offset + i];
    }
    worst.add("adam's way", "adam." + tensor.name, relative_error(gone, way), 2e-3);
  }
  EXPECT_GT(moved, layout.tensors().size() / 2);
  return worst;
}

// SYNPO_TORCH_DUMP names another dump to compare with, for instance one at full width.
TEST(SynPo, AgreesWithPyTorch) {
  const char* path = std::getenv("SYNPO_TORCH_DUMP");
  for_every_target([&](const std::string& target) {
    const Worst narrow = compare_with_dump("tests/data/torch_narrow.safetensors");
    if (!path) return;
    std::printf("%s, narrow\n", target.c_str());
    narrow.print();
    std::printf("%s, %s\n", target.c_str(), path);
    compare_with_dump(path).print();
  });
}

TEST(SynPo, OneAndTwoThreadsGiveTheSameBits) {
  for (const bool full : {false, true})
    for (const bool normalise : {false, true}) {
      PolicyShape shape = full ? PolicyShape() : tiny_shape(normalise);
      shape.normalise_input = shape.normalise_embeddings = normalise;
      const RandomSteps<float> steps(full ? 45 : 141, shape, 4);
      std::vector<Network<float>> nets;
      for (const int threads : {1, 2}) {
        Network<float>& net = nets.emplace_back(shape);
        Parallel parallel(threads);
        net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
        net.step(parallel, steps.batch(), {0.01, 0.1, 1});
      }
      EXPECT_EQ(nets[0].gradient, nets[1].gradient);
      EXPECT_EQ(nets[0].logits, nets[1].logits);
      EXPECT_EQ(nets[0].statistics, nets[1].statistics);
    }
}

TEST(SynPo, ABatchBehindAnotherIsAsIfItWereAlone) {
  // Memory that an earlier, larger step left behind must not show.
  const PolicyShape shape = tiny_shape(true);
  const RandomSteps<float> large(70, shape, 4), small(9, shape, 5);
  Parallel parallel(2);
  Network<float> fresh(shape), used(shape);
  for (Network<float>* net : {&fresh, &used}) net->policy.initialise({3, 1}, net->parameters.data(), net->statistics.data());
  const std::vector<float> statistics = used.statistics;
  used.step(parallel, large.batch(), {0.01, 0.1, 1});
  used.statistics = statistics;
  used.infer(parallel, large.batch(), 32);
  used.step(parallel, small.batch(), {0.01, 0.1, 1});
  fresh.step(parallel, small.batch(), {0.01, 0.1, 1});
  EXPECT_EQ(used.gradient, fresh.gradient);
  EXPECT_EQ(used.statistics, fresh.statistics);
}

TEST(SynPo, InferenceDoesNotDependOnNeighboursOrThreads) {
  for (const bool full : {false, true}) {
    PolicyShape shape = full ? PolicyShape() : tiny_shape(true);
    const RandomSteps<float> steps(39, shape, 6);
    Network<float> net(shape);
    Parallel one(1), two(2);
    net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
    net.step(one, steps.batch(), {0.01, 0.1, 1});
    const std::vector<float> together = net.infer(one, steps.batch(), 32);
    EXPECT_EQ(net.infer(two, steps.batch(), 32), together);
    for (const int at_once : {1, 3, 17}) EXPECT_EQ(net.infer(two, steps.batch(), at_once), together) << at_once << " at once";
  }
}

TEST(SynPo, InferenceWithTheBatchsOwnStatisticsIsTraining) {
  // Statistics that equal the batch's make frozen and training normalisation the same, but for the unbiased variance.
  PolicyShape shape = tiny_shape(true);
  const RandomSteps<double> steps(60, shape, 6);
  Network<double> net(shape);
  Parallel parallel(1);
  net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
  for (int i = 0; i < 100; ++i) net.step(parallel, steps.batch(), {0.01, 0.1, 1});
  EXPECT_LT(relative_error(net.infer(parallel, steps.batch(), 32), net.logits), 0.03);
}

int pixel(uint8_t colour, int channel) {
  const Rgb& rgb = kPalette[colour];
  return channel % 3 == 0 ? rgb.r : channel % 3 == 1 ? rgb.g : rgb.b;
}

TEST(SynPo, StatisticsOfTheInputAreThePixels) {
  const PolicyShape shape = tiny_shape(true);
  const RandomSteps<double> steps(37, shape, 6);
  Network<double> net(shape);
  Parallel parallel(2);
  net.policy.initialise({3, 1}, net.parameters.data(), net.statistics.data());
  net.step(parallel, steps.batch(), {0.01, 0.1, 1});
  const size_t mean_at = net.policy.statistics().find("encoder.input.mean")->offset, variance_at = net.policy.statistics().find("encoder.input.variance")->offset;
  for (int channel = 0; channel < kViewChannels; ++channel) {
    const double count = 37 * kGridCells;
    double sum = 0, squares = 0;
    for (size_t at = channel / 3; at < steps.pictures.size(); at += kHistory) {
      sum += pixel(steps.pictures[at], channel);
      squares += std::pow(pixel(steps.pictures[at], channel), 2);
    }
    EXPECT_NEAR(net.statistics[mean_at + channel], 0.1 * sum / count, 1e-9);
    EXPECT_NEAR(net.statistics[variance_at + channel], 0.9 + 0.1 * (squares - sum * sum / count) / (count - 1), 1e-8);
  }
}

TEST(SynPo, ANormalisedInputIsOtherWeightsAndShifts) {
  // With nothing but centre taps in the first layer, mean and deviation of a pixel can be put into its weights and the shifts behind them.
  PolicyShape shape = tiny_shape(false);
  Network<double> plain(shape);
  shape.normalise_input = true;
  Network<double> normalised(shape);
  const RandomSteps<double> steps(20, shape, 6);
  Parallel parallel(1);
  plain.policy.initialise({3, 1}, plain.parameters.data(), plain.statistics.data());
  plain.step(parallel, steps.batch(), {0, 0, 0});
  std::vector<double> mean = random_values<double>(kViewChannels, 1), deviation = random_values<double>(kViewChannels, 2);
  const auto statistic = [](Network<double>& net, const std::string& name) { return net.statistics.data() + net.policy.statistics().find(name)->offset; };
  for (int c = 0; c < kViewChannels; ++c) {
    statistic(normalised, "encoder.input.mean")[c] = mean[c] = 60 + 50 * mean[c];
    deviation[c] = 70 + 30 * deviation[c];
    statistic(normalised, "encoder.input.variance")[c] = deviation[c] * deviation[c] - 1e-5;
  }
  for (const TensorInfo& tensor : plain.policy.statistics().tensors())
    std::copy_n(statistic(plain, tensor.name), tensor.size, statistic(normalised, tensor.name));
  const int out = shape.channels[0];
  double* weights = plain.parameters.data() + plain.policy.parameters().find("encoder.stage1.block1.conv1.weight")->offset;
  for (int tap = 0; tap < 9; ++tap)
    if (tap != 4) std::fill_n(weights + tap * kViewChannels * out, kViewChannels * out, 0.0);
  normalised.parameters = plain.parameters;
  for (const auto& [conv, norm] : {std::pair<std::string, std::string>{"conv1", "norm1"}, {"shortcut", "shortcut_norm"}}) {
    const std::string block = "encoder.stage1.block1.";
    const auto parameter = [&](const std::string& name) { return plain.parameters.data() + plain.policy.parameters().find(block + name)->offset; };
    double* w = parameter(conv + ".weight") + (conv == "conv1" ? 4 * kViewChannels * out : 0);
    for (int c = 0; c < kViewChannels; ++c)
      for (int o = 0; o < out; ++o) {
        double& weight = w[c * out + o];
        const double slope = parameter(norm + ".scale")[o] / std::sqrt(statistic(plain, block + norm + ".variance")[o] + kNormEpsilon);
        parameter(norm + ".shift")[o] -= slope * weight * mean[c] / deviation[c];
        weight *= 64 / deviation[c];
      }
  }
  EXPECT_LT(relative_error(plain.infer(parallel, steps.batch(), 32), normalised.infer(parallel, steps.batch(), 32)), 1e-10);
}

TEST(SynPo, StartsAsToldByTheSeed) {
  const PolicyShape shape = tiny_shape(false);
  Network<float> a(shape), b(shape), other(shape), wide(shape);
  a.policy.initialise({3, 0}, a.parameters.data(), a.statistics.data());
  b.policy.initialise({3, 0}, b.parameters.data(), b.statistics.data());
  other.policy.initialise({4, 0}, other.parameters.data(), other.statistics.data());
  wide.policy.initialise({3, 2.5}, wide.parameters.data(), wide.statistics.data());
  EXPECT_EQ(a.parameters, b.parameters);
  const Layout& layout = a.policy.parameters();
  const auto largest = [&](const Network<float>& net, const char* name) {
    const TensorInfo& tensor = *layout.find(name);
    float top = 0;
    for (size_t i = 0; i < tensor.size; ++i) top = std::max(top, std::abs(net.parameters[tensor.offset + i]));
    return top;
  };
  std::set<float> firsts;
  for (const TensorInfo& tensor : layout.tensors()) {
    if (!tensor.name.ends_with(".weight") && tensor.name != "theta" && !tensor.name.starts_with("embedding")) continue;
    EXPECT_NE(a.parameters[tensor.offset], other.parameters[tensor.offset]) << tensor.name;
    EXPECT_TRUE(firsts.insert(a.parameters[tensor.offset]).second) << tensor.name << " repeats another";
  }
  const auto within = [&](const char* name, double bound) {
    EXPECT_LE(largest(a, name), bound) << name;
    EXPECT_GT(largest(a, name), 0.8 * bound) << name;
  };
  within("encoder.stage2.block1.conv1.weight", 1 / std::sqrt(9.0 * 4));
  within("encoder.fc.weight", std::sqrt(6.0 / (24 + 6)));
  within("alpha.hidden.weight", std::sqrt(6.0 / (8 + 7)));
  within("theta", 1 / std::sqrt(5.0 * 6 * 5));
  EXPECT_EQ(largest(a, "alpha.hidden.bias"), 0);
  EXPECT_EQ(largest(a, "encoder.stage1.block1.norm1.scale"), 1);
  EXPECT_GT(largest(wide, "embedding.task"), 2.5);
}

TEST(SynPo, FullSizeHasTable2sMultiplyAdds) {
  // As written 14.6 M a state; the transforms leave fewer.
  const SynPo<float> policy{PolicyShape()};
  EXPECT_LT(policy.encoder().multiply_adds(), 14600000u / 2);
  EXPECT_EQ(policy.parameters().find("encoder.fc.weight")->shape, (std::vector<int>{1024, 128}));
  EXPECT_EQ(policy.parameters().find("encoder.stage4.block2.conv2.weight")->shape, (std::vector<int>{3, 3, 256, 256}));
  EXPECT_EQ(policy.parameters().find("theta")->shape, (std::vector<int>{5, 128, 128}));
  EXPECT_EQ(policy.parameters().find("encoder.stage1.block2.shortcut.weight"), nullptr);
  EXPECT_NE(policy.parameters().find("encoder.stage4.block1.shortcut.weight"), nullptr);
}

}  // namespace
}  // namespace synpo
