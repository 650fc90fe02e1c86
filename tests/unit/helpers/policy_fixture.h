// Random steps, small shapes and a policy's arrays, for the tests of every method.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "helpers/numbers.h"
#include "play/model.h"
#include "policy/method/registry.h"
#include "policy/policy.h"
#include "world/grid/grid_set.h"
#include "world/grid/view.h"

namespace synpo {

inline std::vector<uint8_t> bytes_of(const std::vector<float>& values) {
  const uint8_t* bytes = reinterpret_cast<const uint8_t*>(values.data());
  return {bytes, bytes + values.size() * sizeof(float)};
}

inline std::vector<uint8_t> random_observations(int size, const PolicyShape& shape, Random& random) {
  if (shape.observation.sight == Sight::kPictures) {
    std::vector<uint8_t> pictures(size * shape.observation.bytes());
    for (uint8_t& colour : pictures) colour = uint8_t(random.below(uint32_t(shape.observation.palette.size())));
    return pictures;
  }
  const size_t row = shape.observation.bytes() / sizeof(float), views = row - ObservationSpec::kObjectFloats;
  std::vector<float> floats(size * row, 0.0f);
  for (int i = 0; i < size; ++i) {
    for (size_t j = 0; j < views; ++j) floats[i * row + j] = float(random.uniform());
    floats[i * row + views] = float(random.below(uint32_t(shape.observation.objects)));
  }
  return bytes_of(floats);
}

// Steps with everything drawn at random.
template <class T>
struct RandomSteps {
  RandomSteps(int size, const PolicyShape& shape, uint64_t seed)
      : reward(random_values<T>(size, seed)), planner_q(random_values<T>(size_t(size) * shape.actions, seed + 1)) {
    Random random(seed, Purpose::kBatch);
    observations = random_observations(size, shape, random);
    for (int i = 0; i < size; ++i) {
      env.push_back(int(random.below(uint32_t(shape.envs))));
      task.push_back(int(random.below(uint32_t(shape.tasks))));
      label.push_back(int(random.below(uint32_t(shape.actions))));
      taken.push_back(int(random.below(uint32_t(shape.actions))));
    }
    for (int i = 0; i < size; ++i) next.push_back(int(random.below(uint32_t(size + 2))) - 2);
  }
  StepBatch<T> batch(uint64_t update = 0) const {
    return {.size = int(env.size()),
            .observations = observations.data(),
            .env = env.data(),
            .task = task.data(),
            .label = label.data(),
            .taken = taken.data(),
            .reward = reward.data(),
            .seed = 1,
            .update = update,
            .next = next.data(),
            .planner_q = planner_q.data()};
  }
  std::vector<uint8_t> observations;
  std::vector<int> env, task, label, taken, next;
  std::vector<T> reward, planner_q;
};

// A policy with its arrays.
template <class T>
struct Network {
  explicit Network(const PolicyShape& shape, const std::string& method = "synpo")
      : policy(make_policy<T>(method, shape)), actions(shape.actions), parameters(policy->parameters().total(), T(0)),
        statistics(policy->statistics().total(), T(0)), gradient(parameters.size(), T(0)) {}
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const StepOptions& options) {
    logits.assign(size_t(batch.size) * actions, T(0));
    return policy->step(parallel, batch, options, parameters.data(), statistics.data(), gradient.data(), logits.data());
  }
  // Each state's scores, of the pairs as they stand in the batch.
  std::vector<T> infer(Parallel& parallel, const StepBatch<T>& batch, int at_once) {
    std::vector<std::pair<int, int>> pairs;
    std::vector<int> numbers;
    for (int i = 0; i < batch.size; ++i) {
      pairs.emplace_back(batch.env[i], batch.task[i]);
      numbers.push_back(i);
    }
    policy->prepare_inference(parallel, parameters.data(), statistics.data(), pairs);
    std::vector<T> scores(size_t(batch.size) * actions);
    const int shards = shard_count(batch.size, at_once);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(batch.size, at_once, shard);
      policy->infer(thread, range.size(), batch.observations + range.begin * policy->observation_size(),
                    numbers.data() + range.begin, scores.data() + size_t(range.begin) * actions);
    });
    return scores;
  }
  void initialise(const InitOptions& options = {3, 1}) {
    policy->initialise(options, parameters.data(), statistics.data());
  }
  // Biases are zero at first, and scales one: nothing is after this.
  void shake() {
    const std::vector<double> by = random_values<double>(parameters.size(), 8);
    for (const TensorInfo& tensor : policy->parameters().tensors())
      for (size_t i = tensor.offset; i < tensor.offset + tensor.size; ++i) parameters[i] += T(0.2 * by[i]);
  }
  T* parameter(const std::string& name) { return parameters.data() + policy->parameters().find(name)->offset; }
  const T* gradient_of(const std::string& name) const {
    return gradient.data() + policy->parameters().find(name)->offset;
  }

  std::unique_ptr<Policy<T>> policy;
  int actions;
  std::vector<T> parameters, statistics, gradient, logits;
};

// For GridWorld.
inline PolicyShape paper_shape() {
  PolicyShape shape;
  shape.observation = grid_observation_spec();
  return shape;
}

inline PolicyShape tiny_shape(bool normalise) {
  PolicyShape shape = paper_shape();
  shape.channels = {4, 5, 4, 6};
  shape.envs = 3;
  shape.tasks = 4;
  shape.feature = 6;
  shape.basis = 5;
  shape.embedding = 4;
  shape.hidden = 7;
  shape.head_hidden = 9;
  shape.seam = 5;
  shape.normalise_input = shape.normalise_embeddings = normalise;
  return shape;
}

// That of a policy of features, which has an action count of its own.
inline PolicyShape tiny_feature_shape() {
  PolicyShape shape = tiny_shape(false);
  shape.observation = {Sight::kFeatures, 0, {}, 5, 3};
  shape.views = {4, 2, 6};
  shape.actions = 7;
  return shape;
}

inline PolicyShape tiny_shape_for(const World& world) {
  PolicyShape shape = tiny_shape(false);
  shape.envs = world.envs();
  shape.tasks = world.task_count();
  return shape;
}

// Holds the gradient, of the tensors for which `chosen(name)`, to finite differences of what `value(losses)` makes of a
// step's losses.
template <class Value, class Chosen>
void expect_finite_differences(Network<double>& net, const StepBatch<double>& batch, const StepOptions& options,
                               Value value, Chosen chosen) {
  Parallel parallel(1);
  const std::vector<double> statistics = net.statistics;
  const auto loss = [&] {
    net.statistics = statistics;
    return value(net.step(parallel, batch, options));
  };
  const double here = loss();
  const std::vector<double> gradient = net.gradient;
  // A ReLU that changes sign within the step would bend the loss: the slopes to both sides then differ by a part of the
  // gradient, where without they differ by the step times the curvature. The step is so small that none does, and the
  // slopes are held to that.
  constexpr double kStep = 1e-7;
  Random random(1, Purpose::kInit, 9);
  int checked = 0;
  for (const TensorInfo& tensor : net.policy->parameters().tensors()) {
    if (!chosen(tensor.name)) continue;
    ++checked;
    double norm = 0;
    for (size_t i = 0; i < tensor.size; ++i) norm += std::pow(gradient[tensor.offset + i], 2) / tensor.size;
    norm = std::sqrt(norm);
    EXPECT_GT(norm, 1e-6) << tensor.name;
    // The encoder, whose tensors are most, is the same in every method.
    const int draws = tensor.name.starts_with("encoder.") ? 4 : 8;
    for (int draw = 0; draw < draws; ++draw) {
      const size_t at = tensor.offset + random.below(uint32_t(tensor.size));
      const double kept = net.parameters[at];
      net.parameters[at] = kept + kStep;
      const double right = (loss() - here) / kStep;
      net.parameters[at] = kept - kStep;
      const double left = (here - loss()) / kStep;
      net.parameters[at] = kept;
      ASSERT_NEAR(left, right, 1e-3 * (norm + std::abs(gradient[at])))
          << tensor.name << ": a ReLU near zero? take another seed";
      ASSERT_NEAR(gradient[at], (left + right) / 2, 1e-5 * (norm + std::abs(gradient[at])))
          << tensor.name << " at " << at - tensor.offset;
    }
  }
  EXPECT_GT(checked, 0);
}

}  // namespace synpo
