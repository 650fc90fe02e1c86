#include "policy/value_function.h"

#include <algorithm>
#include <cstddef>

namespace synpo {

ValueFunction::ValueFunction(const PolicyShape& shape, const Policy<float>& policy, int hidden)
    : feature_(shape.feature), env_{policy.embeddings(PairSide::kEnv), shape.envs}, task_{policy.embeddings(
                                                                                              PairSide::kTask),
                                                                                          shape.tasks},
      perceptron_([&] {
        for (Side* side : {&env_, &task_})
          if (side->table) side->width = shape.embedding;
        return Perceptron<float>("value", inputs(), hidden, 1, parameters_);
      }()) {}

std::vector<float> ValueFunction::make_inputs(int n, const float* psi, const int* env, const int* task,
                                              const float* policy_parameters) const {
  std::vector<float> inputs(size_t(n) * this->inputs(), 0.0f);
  float* x = inputs.data();
  const auto put = [&](const Side& side, int row) {
    if (side.table)
      std::copy_n(policy_parameters + side.table->offset + size_t(row) * side.width, side.width, x);
    else
      x[row] = 1;
    x += side.width;
  };
  for (int i = 0; i < n; ++i) {
    x = std::copy_n(psi + size_t(i) * feature_, feature_, x);
    put(env_, env[i]);
    put(task_, task[i]);
  }
  return inputs;
}

const float* ValueFunction::forward(Parallel& parallel, int n, const float* psi, const int* env, const int* task,
                                    const float* policy_parameters, const float* parameters) {
  x_ = make_inputs(n, psi, env, task, policy_parameters);
  return perceptron_.forward(parallel, n, x_.data(), parameters);
}

void ValueFunction::backward(Parallel& parallel, float weight, float* dvalue, const float* parameters, float* gradient,
                             float* dpsi) {
  std::vector<float> dx(x_.size());
  std::fill_n(gradient, parameters_.total(), 0.0f);
  perceptron_.backward(parallel, x_.data(), dvalue, dx.data(), false, parameters, gradient);
  const size_t in = size_t(inputs()), n = x_.size() / in, feature = size_t(feature_);
  for (size_t i = 0; i < n; ++i)
    for (size_t c = 0; c < feature; ++c) dpsi[i * feature + c] += weight * dx[i * in + c];
  for (size_t i = 0; i < parameters_.total(); ++i) gradient[i] *= weight;
}

void ValueFunction::infer(int n, const float* psi, const int* env, const int* task, const float* policy_parameters,
                          float* values) const {
  const std::vector<float> x = make_inputs(n, psi, env, task, policy_parameters);
  Buffer<float> scratch;
  perceptron_.infer(n, x.data(), values, scratch);
}

}  // namespace synpo
