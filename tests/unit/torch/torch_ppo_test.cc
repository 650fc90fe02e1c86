// Advantages, the clipped loss and RMSProp against the numbers of tests/torch/torch_ppo.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "format/safetensors.h"
#include "helpers/numbers.h"
#include "learn/ppo/gae.h"
#include "nn/clipped_objective.h"
#include "nn/rmsprop.h"

namespace synpo {
namespace {

// The one in the tree, and what SYNPO_TORCH_PPO_DUMP names besides.
std::vector<std::string> dumps() {
  std::vector<std::string> paths = {"tests/data/torch_ppo.safetensors"};
  if (const char* given = std::getenv("SYNPO_TORCH_PPO_DUMP")) paths.push_back(given);
  return paths;
}

class TorchPpo : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    Input input(GetParam());
    dump_ = read_safetensors(input);
  }
  double number(const char* name) const { return std::atof(dump_.meta(name).c_str()); }
  template <class T = float>
  std::vector<T> get(const char* name) const {
    return dump_.get<T>(name);
  }
  std::vector<int> whole_numbers(const char* name) const {
    const std::vector<int64_t> values = get<int64_t>(name);
    return {values.begin(), values.end()};
  }

  SafeTensors dump_;
};
INSTANTIATE_TEST_SUITE_P(Dump, TorchPpo, testing::ValuesIn(dumps()),
                         [](const auto& info) { return std::filesystem::path(info.param).stem().string(); });

TEST_P(TorchPpo, AgreesOnAdvantages) {
  const std::vector<float> reward = get("gae.reward"), value = get("gae.value"), cut_value = get("gae.cut_value"),
                           last_value = get("gae.last_value");
  std::vector<StepEnd> end;
  for (const uint8_t how : get<uint8_t>("gae.end")) end.push_back(StepEnd(how));
  for (const StepEnd how : {StepEnd::kGoesOn, StepEnd::kTerminated, StepEnd::kTruncated})
    ASSERT_TRUE(std::ranges::count(end, how) > 0);
  const int lanes = int(last_value.size()), steps = int(end.size()) / lanes;
  const std::vector<float> got =
      advantages({steps, lanes, reward.data(), value.data(), end.data(), cut_value.data(), last_value.data()},
                 {number("discount"), number("lambda")});
  EXPECT_LT(relative_error(got, get<double>("gae.advantage")), 1e-6);
}

TEST_P(TorchPpo, AgreesOnTheClippedLossAndItsGradients) {
  const std::vector<float> logits = get("clip.logits"), old = get("clip.old_log_probability"),
                           advantage = get("clip.advantage"), predicted = get("clip.predicted"),
                           target = get("clip.target");
  const std::vector<int> action = whole_numbers("clip.action");
  const int n = int(action.size()), actions = int(logits.size()) / n;
  std::vector<float> dlogits(logits.size()), dpredicted(predicted.size());
  const ClippedLosses got =
      clipped_objective({n, action.data(), old.data(), advantage.data()}, {number("clip"), number("entropy")}, actions,
                        logits.data(), dlogits.data());
  const double value = value_loss(n, predicted.data(), target.data(), dpredicted.data());
  const std::vector<double> want = get<double>("clip.losses"), losses = {got.policy,        value,
                                                                         got.entropy,       got.kl,
                                                                         got.clip_fraction, got.largest_ratio,
                                                                         got.smallest_ratio};
  ASSERT_EQ(losses.size(), want.size());
  for (size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(losses[i], want[i], 1e-6 * std::abs(want[i])) << i;
  EXPECT_LT(relative_error(dlogits, get<double>("clip.dlogits")), 1e-6);
  EXPECT_LT(relative_error(dpredicted, get<double>("clip.dpredicted")), 1e-6);
}

template <class T>
std::vector<T> as(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

// PyTorch divides by the gradient's length + 1e-6 where it clips.
template <class T>
void expect_rmsprop(const SafeTensors& dump, const RmsPropOptions& options, double longest, double limit) {
  Parallel parallel(1);
  const std::vector<double> start = dump.get<double>("rmsprop.parameter"),
                            gradients = dump.get<double>("rmsprop.gradient"), after = dump.get<double>("rmsprop.after");
  const size_t count = start.size();
  std::vector<T> parameter = as<T>(start), v(count, T(0));
  int clipped = 0, steps = 0;
  for (size_t at = 0; at < gradients.size(); at += count, ++steps) {
    std::vector<T> gradient = as<T>({gradients.begin() + at, gradients.begin() + at + count});
    const double factor = clip_factor(std::sqrt(sum_of_squares(parallel, count, gradient.data())), longest);
    clipped += factor < 1;
    rmsprop_step(parallel, options, count, T(factor), gradient.data(), parameter.data(), v.data());
    std::vector<double> gone(count), way(count);
    for (size_t i = 0; i < count; ++i) {
      gone[i] = double(parameter[i]) - start[i];
      way[i] = after[at + i] - start[i];
    }
    EXPECT_LT(relative_error(gone, way), limit) << "step " << steps;
  }
  EXPECT_LT(relative_error(v, dump.get<double>("rmsprop.square")), limit);
  EXPECT_TRUE(0 < clipped && clipped < steps);
}

TEST_P(TorchPpo, AgreesOnRmsProp) {
  const RmsPropOptions options = {number("lr"), number("alpha"), number("eps"), number("weight_decay")};
  expect_rmsprop<double>(dump_, options, number("gradient_norm"), 2e-6);
  expect_rmsprop<float>(dump_, options, number("gradient_norm"), 1e-5);
}

}  // namespace
}  // namespace synpo
