#include "policy/encoder/resnet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "helpers/policy_fixture.h"
#include "nn/layers/norm.h"
#include "policy/method/synpo.h"

namespace synpo {
namespace {

int pixel(uint8_t colour, int channel) {
  const Rgb& rgb = kPalette[colour];
  return channel % 3 == 0 ? rgb.r : channel % 3 == 1 ? rgb.g : rgb.b;
}

TEST(SynPo, StatisticsOfTheInputAreThePixels) {
  const PolicyShape shape = tiny_shape(true);
  const RandomSteps<double> steps(37, shape, 6);
  Network<double> net(shape);
  Parallel parallel(2);
  net.initialise();
  net.step(parallel, steps.batch(), {{0.01, 0.1, 1}});
  const size_t mean_at = net.policy->statistics().find("encoder.input.mean")->offset,
               variance_at = net.policy->statistics().find("encoder.input.variance")->offset;
  for (int channel = 0; channel < ObservationSpec::kChannels; ++channel) {
    const double count = 37 * kGridCells;
    double sum = 0, squares = 0;
    for (size_t at = channel / 3; at < steps.observations.size(); at += kHistory) {
      sum += pixel(steps.observations[at], channel);
      squares += std::pow(pixel(steps.observations[at], channel), 2);
    }
    EXPECT_NEAR(net.statistics[mean_at + channel], 0.1 * sum / count, 1e-9);
    EXPECT_NEAR(net.statistics[variance_at + channel], 0.9 + 0.1 * (squares - sum * sum / count) / (count - 1), 1e-8);
  }
}

TEST(SynPo, ANormalisedInputIsOtherWeightsAndShifts) {
  // With nothing but centre taps in the first layer, mean and deviation of a pixel can be put into its weights and the
  // shifts after them.
  PolicyShape shape = tiny_shape(false);
  Network<double> plain(shape);
  shape.normalise_input = true;
  Network<double> normalised(shape);
  const RandomSteps<double> steps(20, shape, 6);
  Parallel parallel(1);
  plain.initialise();
  plain.step(parallel, steps.batch(), {{0, 0, 0}});
  std::vector<double> mean = random_values<double>(ObservationSpec::kChannels, 1),
                      deviation = random_values<double>(ObservationSpec::kChannels, 2);
  const auto statistic = [](Network<double>& net, const std::string& name) {
    return net.statistics.data() + net.policy->statistics().find(name)->offset;
  };
  for (int c = 0; c < ObservationSpec::kChannels; ++c) {
    statistic(normalised, "encoder.input.mean")[c] = mean[c] = 60 + 50 * mean[c];
    deviation[c] = 70 + 30 * deviation[c];
    statistic(normalised, "encoder.input.variance")[c] = deviation[c] * deviation[c] - 1e-5;
  }
  for (const TensorInfo& tensor : plain.policy->statistics().tensors())
    std::copy_n(statistic(plain, tensor.name), tensor.size, statistic(normalised, tensor.name));
  const int out = shape.channels[0];
  double* weights =
      plain.parameters.data() + plain.policy->parameters().find("encoder.stage1.block1.conv1.weight")->offset;
  for (int tap = 0; tap < 9; ++tap)
    if (tap != 4) std::fill_n(weights + tap * ObservationSpec::kChannels * out, ObservationSpec::kChannels * out, 0.0);
  normalised.parameters = plain.parameters;
  for (const auto& [conv, norm] :
       {std::pair<std::string, std::string>{"conv1", "norm1"}, {"shortcut", "shortcut_norm"}}) {
    const std::string block = "encoder.stage1.block1.";
    const auto parameter = [&](const std::string& name) {
      return plain.parameters.data() + plain.policy->parameters().find(block + name)->offset;
    };
    double* w = parameter(conv + ".weight") + (conv == "conv1" ? 4 * ObservationSpec::kChannels * out : 0);
    for (int c = 0; c < ObservationSpec::kChannels; ++c)
      for (int o = 0; o < out; ++o) {
        double& weight = w[c * out + o];
        const double slope =
            parameter(norm + ".scale")[o] / std::sqrt(statistic(plain, block + norm + ".variance")[o] + kNormEpsilon);
        parameter(norm + ".shift")[o] -= slope * weight * mean[c] / deviation[c];
        weight *= 64 / deviation[c];
      }
  }
  EXPECT_LT(relative_error(plain.infer(parallel, steps.batch(), 32), normalised.infer(parallel, steps.batch(), 32)),
            1e-10);
}

// Where threads are many, convolutions are done in stages: batches of less than a part, of some, and of more than a
// slab.
TEST(SynPo, ManyThreadsGiveTheSameBits) {
  for (const int size : {5, 150, 600}) {
    const PolicyShape shape = size == 150 ? tiny_shape(true) : paper_shape();
    const RandomSteps<float> steps(size, shape, 4);
    StepBatch<float> batch = steps.batch();
    for (const bool frozen : {false, true}) {
      batch.frozen_statistics = frozen;
      Network<float> one(shape), many(shape);
      for (Network<float>* net : {&one, &many}) {
        net->initialise();
        net->shake();
        Parallel parallel(net == &one ? 1 : 16);
        net->step(parallel, batch, {{0.01, 0.1, 1}});
      }
      EXPECT_EQ(one.logits, many.logits) << size;
      EXPECT_EQ(one.gradient, many.gradient) << size;
      EXPECT_EQ(one.statistics, many.statistics) << size;
    }
  }
}

TEST(SynPo, StartsAsToldByTheSeed) {
  const PolicyShape shape = tiny_shape(false);
  Network<float> a(shape), b(shape), other(shape), wide(shape);
  a.initialise({3, 0});
  b.initialise({3, 0});
  other.initialise({4, 0});
  wide.initialise({3, 2.5});
  EXPECT_EQ(a.parameters, b.parameters);
  const Layout& layout = a.policy->parameters();
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
  const SynPo<float> policy{paper_shape()};
  EXPECT_LT(policy.encoder().multiply_adds(), 14600000u / 2);
  EXPECT_EQ(policy.parameters().find("encoder.fc.weight")->shape, (std::vector<int>{1024, 128}));
  EXPECT_EQ(policy.parameters().find("encoder.stage4.block2.conv2.weight")->shape, (std::vector<int>{3, 3, 256, 256}));
  EXPECT_EQ(policy.parameters().find("theta")->shape, (std::vector<int>{5, 128, 128}));
  EXPECT_EQ(policy.parameters().find("encoder.stage1.block2.shortcut.weight"), nullptr);
  EXPECT_NE(policy.parameters().find("encoder.stage4.block1.shortcut.weight"), nullptr);
}

}  // namespace
}  // namespace synpo
