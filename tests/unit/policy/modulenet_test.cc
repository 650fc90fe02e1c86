#include "policy/method/modulenet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helpers/policy_fixture.h"

namespace synpo {
namespace {

// ModuleNet with modules that let the seam through: a score is what the mask leaves of 1.
struct OpenSeam {
  OpenSeam() {
    net.initialise();
    for (int task = 0; task < shape.tasks; ++task) {
      const std::string out = "module.task" + std::to_string(task) + ".out.";
      std::fill_n(net.parameter(out + "weight"), shape.head_hidden * shape.seam, 0.0);
      std::fill_n(net.parameter(out + "bias"), shape.seam, 1.0);
    }
    for (int env = 0; env < shape.envs; ++env) {
      const std::string module = "module.env" + std::to_string(env);
      double *hidden = net.parameter(module + ".hidden.weight"), *out = net.parameter(module + ".out.weight");
      std::fill_n(hidden, shape.seam * shape.head_hidden, 0.0);
      std::fill_n(out, shape.head_hidden * shape.actions, 0.0);
      for (int i = 0; i < shape.seam; ++i) hidden[i * shape.head_hidden + i] = out[i * shape.actions + i] = 1;
    }
  }
  std::vector<double> mask(double dropout, uint64_t seed, uint64_t update) {
    Parallel parallel(2);
    StepBatch<double> batch = steps.batch(update);
    batch.seed = seed;
    net.step(parallel, batch, {{0, 0, 0}, dropout});
    return net.logits;
  }
  const PolicyShape shape = tiny_shape(false);
  const RandomSteps<double> steps{400, shape, 4};
  Network<double> net{shape, "modulenet"};
};

TEST(ModuleNet, DropsOutByChanceAndScalesWhatIsLeft) {
  OpenSeam open;
  for (const double dropout : {0.2, 0.7}) {
    int kept = 0;
    const std::vector<double> mask = open.mask(dropout, 1, 5);
    for (const double value : mask) {
      EXPECT_TRUE(value == 0 || std::abs(value - 1 / (1 - dropout)) < 1e-12) << value;
      kept += value != 0;
    }
    const double expected = (1 - dropout) * double(mask.size());
    EXPECT_NEAR(kept, expected, 5 * std::sqrt(expected * dropout));
  }
  EXPECT_EQ(open.mask(0, 1, 5), std::vector<double>(400 * 5, 1.0));
}

TEST(ModuleNet, TheMaskIsNamedBySeedAndUpdate) {
  OpenSeam open;
  const std::vector<double> mask = open.mask(0.5, 1, 5);
  EXPECT_EQ(open.mask(0.5, 1, 5), mask);
  EXPECT_NE(open.mask(0.5, 1, 6), mask);
  EXPECT_NE(open.mask(0.5, 2, 5), mask);
}

TEST(ModuleNet, InferenceDropsNothingOut) {
  OpenSeam open;
  open.mask(0.5, 1, 5);
  Parallel parallel(2);
  EXPECT_EQ(open.net.infer(parallel, open.steps.batch(), 32), std::vector<double>(400 * 5, 1.0));
}

TEST(ModuleNet, ModulesThatABatchLacksGetNoGradient) {
  const PolicyShape shape = tiny_shape(false);
  Network<double> net(shape, "modulenet");
  net.initialise();
  RandomSteps<double> steps(20, shape, 4);
  std::fill(steps.env.begin(), steps.env.end(), 1);
  std::fill(steps.task.begin(), steps.task.end(), 2);
  Parallel parallel(1);
  net.step(parallel, steps.batch(), {});
  for (const TensorInfo& tensor : net.policy->parameters().tensors()) {
    if (!tensor.name.starts_with("module")) continue;
    const double* gradient = net.gradient_of(tensor.name);
    const bool used = tensor.name.starts_with("module.env1.") || tensor.name.starts_with("module.task2.");
    EXPECT_EQ(std::any_of(gradient, gradient + tensor.size, [](double g) { return g != 0; }), used) << tensor.name;
  }
}

}  // namespace
}  // namespace synpo
