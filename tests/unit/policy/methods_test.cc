// All that every method has to keep: gradients, threads, batches one after another, inference; and what only one of
// them does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "helpers/policy_fixture.h"
#include "policy/method/registry.h"

namespace synpo {
namespace {

struct Variant {
  std::string name, method;
  bool normalise = false;
  int action_embedding = 0;
  SfLoss sf_loss = SfLoss::kTemporalDifference;
  Sight sight = Sight::kPictures;
  int side = kGridSide;  // of pictures; others have colours of their own

  PolicyShape shape(bool full = false) const {
    PolicyShape shape = sight == Sight::kFeatures ? tiny_feature_shape() : tiny_shape(normalise);
    if (full && sight == Sight::kFeatures) {
      shape.observation.view = 200;
      shape.observation.objects = 8;
      shape.views = {136, 32, 72};
    } else if (full) {
      shape = paper_shape();
      if (method != "synpo" || action_embedding > 0) shape.channels = tiny_shape(false).channels;
      shape.normalise_input = shape.normalise_embeddings = normalise;
    }
    if (side != kGridSide) shape.observation = {Sight::kPictures, side, {{0, 0, 0}, {250, 90, 10}, {20, 40, 60}}};
    shape.action_embedding = full && action_embedding > 0 ? 32 : action_embedding;
    shape.sf_loss = sf_loss;
    return shape;
  }
  bool temporal_difference() const { return method == "sf" && sf_loss == SfLoss::kTemporalDifference; }
};

std::ostream& operator<<(std::ostream& to, const Variant& variant) { return to << variant.name; }

const Variant kVariants[] = {{"SynPo", "synpo"},
                             {"SynPoOfFeatures", "synpo", false, 0, SfLoss::kTemporalDifference, Sight::kFeatures},
                             {"SynPoNormalised", "synpo", true},
                             {"SynPoOfSmallPictures", "synpo", true, 0, {}, Sight::kPictures, 9},
                             {"SynPoGeneral", "synpo", false, 3},
                             {"SynPoGeneralNormalised", "synpo", true, 7},
                             {"Mtl", "mtl"},
                             {"MtlGeneralNormalised", "mtl", true, 3},
                             {"Mlp", "mlp"},
                             {"MlpNormalised", "mlp", true},
                             {"ModuleNet", "modulenet"},
                             {"SfTemporalDifference", "sf"},
                             {"SfTemporalDifferenceNormalised", "sf", true},
                             {"SfPlannerQ", "sf", false, 0, SfLoss::kPlannerQ},
                             {"SfCrossEntropy", "sf", false, 0, SfLoss::kCrossEntropy}};

class Methods : public testing::TestWithParam<Variant> {
 protected:
  template <class T>
  Network<T> network(bool full = false) const {
    Network<T> net(GetParam().shape(full), GetParam().method);
    net.initialise();
    return net;
  }
};

INSTANTIATE_TEST_SUITE_P(All, Methods, testing::ValuesIn(kVariants), [](const auto& info) { return info.param.name; });

TEST_P(Methods, EveryTensorServesOneEnd) {
  const Network<float> net = network<float>();
  std::map<std::string, int> ends;
  for (const ParameterGroup group :
       {ParameterGroup::kEncoder, ParameterGroup::kEmbeddings, ParameterGroup::kRecognisers,
        ParameterGroup::kCoefficients, ParameterGroup::kHeads})
    for (const TensorInfo* tensor : net.policy->group(group)) ++ends[tensor->name];
  for (const TensorInfo& tensor : net.policy->parameters().tensors()) EXPECT_EQ(ends[tensor.name], 1) << tensor.name;
}

constexpr double kDropout = 0.3;

// SF's temporal difference holds its targets fixed, so that what it calls its gradient is not that of its loss. Where
// they are constant, it is: with phi constant, and no step after it. phi's own gradient has a test below.
TEST_P(Methods, GradientsAreFiniteDifferences) {
  Network<double> net = network<double>();
  net.shake();
  const PolicyShape shape = GetParam().shape();
  const RandomSteps<double> steps(14, shape, 5);
  const bool fixed = GetParam().temporal_difference();
  if (fixed) std::fill_n(net.parameter("phi.out.weight"), shape.head_hidden * shape.actions * shape.embedding, 0.0);
  for (const double dropout : {0.0, kDropout}) {
    if (dropout > 0 && GetParam().method != "modulenet") continue;
    expect_finite_differences(
        net, steps.batch(), {{0.3, 0.5, 0.7}, dropout, /*discount=*/0},
        [](const Losses& losses) { return losses.total; },
        [&](const std::string& name) { return !fixed || !name.starts_with("phi."); });
  }
}

TEST_P(Methods, EveryLossCountsByItsWeight) {
  Network<double> net = network<double>();
  const RandomSteps<double> steps(9, GetParam().shape(), 4);
  Parallel parallel(1);
  const std::vector<double> statistics = net.statistics;
  Losses losses;
  const auto gradient = [&](const LossWeights& weights) {
    net.statistics = statistics;
    losses = net.step(parallel, steps.batch(), {weights});
    double total = losses.policy;
    for (const double part : {weights.reward * losses.reward, weights.env * losses.env, weights.task * losses.task})
      if (!std::isnan(part)) total += part;
    EXPECT_NEAR(losses.total, total, 1e-13);
    return net.gradient;
  };
  const std::vector<double> none = gradient({0, 0, 0});
  std::vector<double> sum = none;
  const Losses at_none = losses;
  for (const auto& [weights, loss] : {std::pair{LossWeights{2, 0, 0}, at_none.reward},
                                      {LossWeights{0, 3, 0}, at_none.env},
                                      {LossWeights{0, 0, 4}, at_none.task}}) {
    const std::vector<double> one = gradient(weights);
    if (std::isnan(loss))
      EXPECT_EQ(one, none);
    else
      EXPECT_GT(relative_error(one, none), 1e-3);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += one[i] - none[i];
  }
  EXPECT_LT(relative_error(gradient({2, 3, 4}), sum), 1e-12);
}

TEST_P(Methods, OneAndTwoThreadsGiveTheSameBits) {
  for (const bool full : {false, true}) {
    const RandomSteps<float> steps(full ? 45 : 141, GetParam().shape(full), 4);
    Network<float> one = network<float>(full), two = network<float>(full);
    Parallel alone(1), together(2);
    one.step(alone, steps.batch(), {{0.01, 0.1, 1}, kDropout});
    two.step(together, steps.batch(), {{0.01, 0.1, 1}, kDropout});
    EXPECT_EQ(one.gradient, two.gradient);
    EXPECT_EQ(one.logits, two.logits);
    EXPECT_EQ(one.statistics, two.statistics);
  }
}

TEST_P(Methods, ABatchAfterAnotherIsAsIfItWereAlone) {
  // Memory that an earlier, larger step left must not show.
  const RandomSteps<float> large(70, GetParam().shape(), 4), small(9, GetParam().shape(), 5);
  Parallel parallel(2);
  Network<float> fresh = network<float>(), used = network<float>();
  const std::vector<float> statistics = used.statistics;
  used.step(parallel, large.batch(), {{0.01, 0.1, 1}, kDropout});
  used.statistics = statistics;
  used.infer(parallel, large.batch(), 32);
  const Losses after = used.step(parallel, small.batch(), {{0.01, 0.1, 1}, kDropout});
  const Losses alone = fresh.step(parallel, small.batch(), {{0.01, 0.1, 1}, kDropout});
  EXPECT_EQ(after.total, alone.total);
  EXPECT_EQ(used.logits, fresh.logits);
  EXPECT_EQ(used.gradient, fresh.gradient);
  EXPECT_EQ(used.statistics, fresh.statistics);
  EXPECT_EQ(used.infer(parallel, small.batch(), 32), fresh.infer(parallel, small.batch(), 32));
}

TEST_P(Methods, InferenceDoesNotDependOnNeighboursOrThreads) {
  for (const bool full : {false, true}) {
    const RandomSteps<float> steps(39, GetParam().shape(full), 6);
    Network<float> net = network<float>(full);
    Parallel one(1), two(2);
    net.step(one, steps.batch(), {{0.01, 0.1, 1}});
    const std::vector<float> together = net.infer(one, steps.batch(), 32);
    EXPECT_EQ(net.infer(two, steps.batch(), 32), together);
    for (const int at_once : {1, 3, 17})
      EXPECT_EQ(net.infer(two, steps.batch(), at_once), together) << at_once << " at once";
  }
}

TEST_P(Methods, InferenceWithTheBatchsOwnStatisticsIsTraining) {
  // Statistics that equal the batch's make frozen and training normalisation the same, but for the unbiased variance.
  const RandomSteps<double> steps(60, GetParam().shape(), 6);
  Network<double> net = network<double>();
  net.shake();
  Parallel parallel(1);
  for (int i = 0; i < 100; ++i) net.step(parallel, steps.batch(), {{0.01, 0.1, 1}});
  EXPECT_LT(relative_error(net.infer(parallel, steps.batch(), 32), net.logits), 0.03);
}

TEST_P(Methods, StartsAsToldByTheSeed) {
  Network<float> a = network<float>(), b = network<float>(), other = network<float>();
  other.initialise({4, 1});
  EXPECT_EQ(a.parameters, b.parameters);
  std::set<float> firsts;
  for (const TensorInfo& tensor : a.policy->parameters().tensors()) {
    const float first = a.parameters[tensor.offset];
    const bool drawn = tensor.name.starts_with("encoder.conv");  // the temporal network's, biases too
    const bool zero = !drawn && (tensor.name.ends_with("bias") || tensor.name.ends_with("shift"));
    EXPECT_EQ(first == 0, zero) << tensor.name;
    if (zero || tensor.name.ends_with("scale")) continue;
    EXPECT_NE(first, other.parameters[tensor.offset]) << tensor.name;
    EXPECT_TRUE(firsts.insert(first).second) << tensor.name << " repeats another";
  }
}

// With the identity for phi the general form is the direct one.
class OneHot : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Methods, OneHot, testing::Values("synpo", "mtl"), [](const auto& info) { return info.param; });

TEST_P(OneHot, GeneralFormIsTheDirectForm) {
  PolicyShape shape = tiny_shape(true);
  Network<double> direct(shape, GetParam());
  shape.action_embedding = shape.actions;
  Network<double> general(shape, GetParam());
  direct.initialise();
  direct.shake();
  general.statistics = direct.statistics;
  for (const TensorInfo& tensor : direct.policy->parameters().tensors())
    std::copy_n(direct.parameter(tensor.name), tensor.size, general.parameter(tensor.name));
  for (int a = 0; a < shape.actions; ++a) general.parameter("phi")[a * shape.actions + a] = 1;
  const RandomSteps<double> steps(70, shape, 4);
  Parallel parallel(2);
  const Losses want = direct.step(parallel, steps.batch(), {{0.3, 0.5, 0.7}}),
               got = general.step(parallel, steps.batch(), {{0.3, 0.5, 0.7}});
  EXPECT_NEAR(got.total, want.total, 1e-12);
  EXPECT_NEAR(got.reward, want.reward, 1e-12);
  EXPECT_NEAR(got.task, want.task, 1e-12);
  EXPECT_LT(relative_error(general.logits, direct.logits), 1e-12);
  for (const TensorInfo& tensor : direct.policy->parameters().tensors())
    EXPECT_LT(relative_error(general.gradient_of(tensor.name), direct.gradient_of(tensor.name), tensor.size), 1e-11)
        << tensor.name;
  EXPECT_LT(relative_error(general.infer(parallel, steps.batch(), 32), direct.infer(parallel, steps.batch(), 32)),
            1e-12);
}

TEST(EveryMethod, ActsAtATemperature) {
  PolicyShape shape = tiny_shape(false);
  for (const char* method : {"synpo", "mlp", "mtl", "modulenet"})
    EXPECT_EQ(make_policy(method, shape)->temperature(), kTemperature);
  for (const SfLoss loss : {SfLoss::kTemporalDifference, SfLoss::kPlannerQ, SfLoss::kCrossEntropy}) {
    shape.sf_loss = loss;
    EXPECT_EQ(make_policy("sf", shape)->temperature(), loss == SfLoss::kCrossEntropy ? kTemperature : 0);
  }
}

}  // namespace
}  // namespace synpo
