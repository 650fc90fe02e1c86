#include "policy/method/sf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "helpers/policy_fixture.h"
#include "policy/method/registry.h"

namespace synpo {
namespace {

struct TemporalDifference {
  TemporalDifference() {
    net.initialise();
    net.shake();
  }
  std::vector<double> gradient(const StepOptions& options) {
    const std::vector<double> statistics = net.statistics;
    Parallel parallel(1);
    losses = net.step(parallel, steps.batch(), options);
    net.statistics = statistics;
    return net.gradient;
  }
  const PolicyShape shape = tiny_shape(false);
  RandomSteps<double> steps{14, shape, 4};
  Network<double> net{shape, "sf"};
  Losses losses;
};

StepOptions discounted(double discount, double reward = 0.3) { return {{reward, 0, 0}, 0, discount}; }

TEST(SfTemporalDifference, IsTheLossByHand) {
  TemporalDifference sf;
  const PolicyShape& shape = sf.shape;
  const size_t width = shape.embedding;
  for (const char* weight : {"phi.out.weight", "psi.out.weight"})
    std::fill_n(sf.net.parameter(weight), shape.head_hidden * shape.actions * width, 0.0);
  const double *phi = sf.net.parameter("phi.out.bias"), *psi = sf.net.parameter("psi.out.bias"),
               *task = sf.net.parameter("embedding.task");
  const auto value = [&](int action, const double* features, int of_task) {
    return std::inner_product(features + action * width, features + (action + 1) * width, task + of_task * width, 0.0);
  };
  const RandomSteps<double>& steps = sf.steps;
  double sum = 0, reward = 0;
  int counted = 0;
  std::set<int> kinds;
  for (int i = 0; i < 14; ++i) {
    kinds.insert(std::min(steps.next[i], 0));
    reward += std::pow(value(steps.taken[i], phi, steps.task[i]) - steps.reward[i], 2) / 14;
    if (steps.next[i] == StepBatch<double>::kUnknown) continue;
    ++counted;
    for (size_t c = 0; c < width; ++c) {
      const double next_psi =
          steps.next[i] == StepBatch<double>::kTerminal ? 0 : psi[steps.label[steps.next[i]] * width + c];
      sum += std::pow(psi[steps.taken[i] * width + c] - phi[steps.taken[i] * width + c] - 0.9 * next_psi, 2);
    }
  }
  ASSERT_EQ(kinds.size(), 3u);
  sf.gradient(discounted(0.9));
  EXPECT_NEAR(sf.losses.policy, sum / double(counted * width), 1e-12);
  EXPECT_NEAR(sf.losses.reward, reward, 1e-12);
  EXPECT_TRUE(std::isnan(sf.losses.env) && std::isnan(sf.losses.task));
  for (int i = 0; i < 14; ++i)
    for (int a = 0; a < shape.actions; ++a) EXPECT_NEAR(sf.net.logits[i * 5 + a], value(a, psi, steps.task[i]), 1e-12);
}

TEST(SfTemporalDifference, PhiLearnsFromTheRewardAlone) {
  TemporalDifference sf;
  expect_finite_differences(
      sf.net, sf.steps.batch(), discounted(0.9, 0.3), [](const Losses& losses) { return 0.3 * losses.reward; },
      [](const std::string& name) { return name.starts_with("phi."); });
}

TEST(SfTemporalDifference, TargetsAreHeldFixed) {
  // The loss is quadratic in the discount, and so is its own gradient; with targets held fixed it is linear.
  TemporalDifference sf;
  const std::vector<double> none = sf.gradient(discounted(0)), half = sf.gradient(discounted(0.5)),
                            whole = sf.gradient(discounted(1));
  std::vector<double> between(none.size());
  for (size_t i = 0; i < none.size(); ++i) between[i] = (none[i] + whole[i]) / 2;
  EXPECT_LT(relative_error(half, between), 1e-12);
  EXPECT_GT(relative_error(none, whole), 1e-3);
}

TEST(SfTemporalDifference, ABatchOfUnknownStepsTeachesTheRewardAlone) {
  TemporalDifference sf;
  std::fill(sf.steps.next.begin(), sf.steps.next.end(), StepBatch<double>::kUnknown);
  sf.gradient(discounted(0.9));
  EXPECT_EQ(sf.losses.policy, 0);
  EXPECT_EQ(sf.net.gradient_of("psi.out.bias")[0], 0);
  EXPECT_NE(sf.net.gradient_of("phi.out.bias")[0] + sf.net.gradient_of("phi.out.bias")[5], 0);
}

TEST(Sf, AsksForWhatItsLossNeeds) {
  PolicyShape shape = tiny_shape(false);
  const auto needs = [&](SfLoss loss) {
    shape.sf_loss = loss;
    return make_policy("sf", shape)->needs();
  };
  EXPECT_TRUE(needs(SfLoss::kTemporalDifference).next && !needs(SfLoss::kTemporalDifference).planner_q);
  EXPECT_TRUE(!needs(SfLoss::kPlannerQ).next && needs(SfLoss::kPlannerQ).planner_q);
  EXPECT_TRUE(!needs(SfLoss::kCrossEntropy).next && !needs(SfLoss::kCrossEntropy).planner_q);
}

}  // namespace
}  // namespace synpo
