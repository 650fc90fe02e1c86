#include "learn/ppo/ppo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "helpers/policy_fixture.h"
#include "policy/method/encoded_policy.h"
#include "policy/method/registry.h"

namespace synpo {
namespace {

// --- frozen statistics, and objectives of one's own

// A loss with gradients into scores and psi: sum of w * logits plus sum of u * psi.
struct Linear : Objective<double> {
  double apply(Parallel&, int n, const double* psi, const double* logits, double* dlogits, double* dpsi) override {
    double sum = 0;
    for (int i = 0; i < n * actions; ++i) sum += (dlogits[i] = std::sin(i + 1.0)) * logits[i];
    for (int i = 0; i < n * feature; ++i) {
      dpsi[i] += std::cos(i + 1.0);
      sum += std::cos(i + 1.0) * psi[i];
    }
    return sum;
  }
  int actions, feature;
};

TEST(Objective, ItsGradientGoesThroughEveryMethodUnderFrozenStatistics) {
  for (const std::string& method : method_names()) {
    SCOPED_TRACE(method);
    const PolicyShape shape = tiny_shape(method == "mlp");
    Network<double> net(shape, method);
    net.initialise();
    net.shake();
    const RandomSteps<double> steps(9, shape, 4);
    Parallel parallel(1);
    for (int i = 0; i < 3; ++i)
      net.step(parallel, RandomSteps<double>(9, shape, 5).batch(), {});  // statistics to be frozen
    const std::vector<double> statistics = net.statistics;
    Linear objective;
    objective.actions = shape.actions;
    objective.feature = shape.feature;
    StepBatch<double> batch = steps.batch();
    batch.objective = &objective;
    batch.frozen_statistics = true;
    expect_finite_differences(
        net, batch, {{0.3, 0.5, 0.7}}, [](const Losses& losses) { return losses.total; },
        [](const std::string&) { return true; });
    EXPECT_EQ(net.statistics, statistics) << "frozen";
  }
}

TEST(Objective, AStepUnderFrozenStatisticsScoresAsInferenceDoes) {
  for (const std::string& method : method_names()) {
    const PolicyShape shape = tiny_shape(true);
    Network<float> net(shape, method);
    net.initialise();
    const RandomSteps<float> steps(39, shape, 6);
    Parallel parallel(2);
    net.step(parallel, steps.batch(), {});
    StepBatch<float> batch = steps.batch();
    batch.frozen_statistics = true;
    net.step(parallel, batch, {});
    EXPECT_EQ(net.infer(parallel, batch, 8), net.logits) << method;
  }
}

TEST(Objective, AStepFromPsiIsTheStepAfterTheEncoder) {
  const PolicyShape shape = tiny_shape(false);
  Network<float> whole(shape), from_psi(shape);
  for (Network<float>* net : {&whole, &from_psi}) net->initialise();
  const RandomSteps<float> steps(39, shape, 6);
  Parallel parallel(1);
  const Losses losses = whole.step(parallel, steps.batch(), {});
  StepBatch<float> batch = steps.batch();
  batch.psi = dynamic_cast<EncodedPolicy<float>&>(*whole.policy).last_feature();
  batch.observations = nullptr;
  EXPECT_EQ(from_psi.step(parallel, batch, {}).total, losses.total);
  EXPECT_EQ(from_psi.logits, whole.logits);
  for (const TensorInfo& tensor : whole.policy->parameters().tensors())
    for (size_t i = tensor.offset; i < tensor.offset + tensor.size; ++i)
      if (tensor.name.starts_with("encoder."))
        ASSERT_EQ(from_psi.gradient[i], 0) << tensor.name;
      else
        ASSERT_EQ(from_psi.gradient[i], whole.gradient[i]) << tensor.name;
}

// --- the algorithm

PpoOptions small_ppo() {
  PpoOptions options;
  options.lanes = 5;
  options.rollout = 12;
  options.epochs = 2;
  options.minibatches = 3;
  options.value_warm_up = 1;
  options.value_hidden = 8;
  options.optimiser.learning_rate = 1e-3;
  return options;
}

Model small_model(const World& world, const std::string& method) {
  Model model = fresh_model(method, tiny_shape_for(world), {3, 1});
  model.seen = {{0, 3}, {2, 5}, {1, 7}};
  return model;
}

std::string bytes(const Ppo& run) { return format_checkpoint(run.checkpoint(true)); }

std::vector<float> weights(const Ppo& run) {
  const float* const first = run.model().parameters.data();
  return {first, first + run.model().policy->parameters().total()};
}

TEST(Ppo, TheFirstMinibatchAfterARolloutHasRatioOneAndNoDivergence) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(2);
  for (const std::string& method : method_names()) {
    SCOPED_TRACE(method);
    Ppo run(world, parallel, small_model(world, method), small_ppo(), 4);
    for (int i = 0; i < 4; ++i) {
      run.update();
      const PpoLosses& first = run.first_minibatch();
      EXPECT_NEAR(first.largest_ratio, 1, 1e-6);  // log-probabilities are kept as float
      EXPECT_NEAR(first.smallest_ratio, 1, 1e-6);
      EXPECT_NEAR(first.kl, 0, 1e-12);
      EXPECT_EQ(first.clip_fraction, 0);
    }
  }
}

TEST(Ppo, MovesTheValueAloneAtFirstAndThenThePolicy) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(1);
  Ppo run(world, parallel, small_model(world, "synpo"), small_ppo(), 4);
  const std::vector<float> before = weights(run);
  run.update();
  EXPECT_EQ(weights(run), before);
  run.update();
  EXPECT_NE(weights(run), before);
  EXPECT_EQ(run.steps(), 2 * 5 * 12);
}

TEST(Ppo, OnePassOverARolloutIsEnoughToMoveThePolicy) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(1);
  PpoOptions options = small_ppo();
  options.epochs = 1;
  options.value_warm_up = 0;
  Ppo run(world, parallel, small_model(world, "synpo"), options, 4);
  const std::vector<float> before = weights(run);
  run.update();
  EXPECT_NE(weights(run), before);
}

TEST(Ppo, ThreadsDoNotShowAndAResumedRunGoesOnToTheSameBits) {
  const GridSet world = GridSet::open("gridworld");
  Parallel one(1), two(2);
  Ppo straight(world, one, small_model(world, "synpo"), small_ppo(), 4),
      other(world, two, small_model(world, "synpo"), small_ppo(), 4);
  for (int i = 0; i < 2; ++i) {
    straight.update();
    other.update();
  }
  EXPECT_TRUE(bytes(other) == bytes(straight)) << "threads show";
  for (int i = 0; i < 2; ++i) straight.update();
  const Checkpoint kept = other.checkpoint(true);
  Ppo resumed(world, two, load_model(kept, world), small_ppo(), 4);
  resumed.resume(kept);
  for (int i = 0; i < 2; ++i) resumed.update();
  EXPECT_TRUE(bytes(resumed) == bytes(straight)) << "the resumed run went another way";
}

TEST(Ppo, LearnsToLeaveTheWrongTreasures) {
  const GridSet world = GridSet::open("gridworld");
  Parallel parallel(1);
  PpoOptions options = small_ppo();
  options.lanes = 16;
  options.rollout = 32;
  options.minibatches = 4;
  Model model = small_model(world, "synpo");
  model.seen = {{0, 3}};
  Ppo run(world, parallel, std::move(model), options, 4);
  run.measure_statistics(10);
  for (int i = 0; i < 8; ++i) run.update();
  const double early = run.take_report().finished.wrong;
  for (int i = 0; i < 30; ++i) run.update();
  run.take_report();
  for (int i = 0; i < 8; ++i) run.update();
  EXPECT_LT(run.take_report().finished.wrong, early) << "wrong picks cost 10 and are soon left";
}

}  // namespace
}  // namespace synpo
