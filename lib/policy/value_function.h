// The value of states, for PPO: V(s) = f([psi(s), e_env, e_task]), f a perceptron. The embeddings are the policy's own,
// and learn nothing from it; for a method without one of the two tables, one-hot in its place.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "nn/layout.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

class ValueFunction {
 public:
  // `hidden` units. The policy must live as long.
  ValueFunction(const PolicyShape& shape, const Policy<float>& policy, int hidden);
  const Layout& parameters() const { return parameters_; }

  void initialise(InitStream& stream, float* parameters) const { perceptron_.initialise(stream, parameters); }

  // n states of a training step: psi [n, feature], env and task [n]. The values [n] stay until the next call.
  const float* forward(Parallel& parallel, int n, const float* psi, const int* env, const int* task,
                       const float* policy_parameters, const float* parameters);
  // From `weight` times dvalue [n], the gradient of the last values: `gradient` =, dpsi +=.
  void backward(Parallel& parallel, float weight, float* dvalue, const float* parameters, float* gradient, float* dpsi);

  // Takes over the parameters for infer(), but for the policy's, which are read there. One thread's part.
  void prepare_inference(const float* parameters) { perceptron_.prepare_inference(parameters); }
  void infer(int n, const float* psi, const int* env, const int* task, const float* policy_parameters,
             float* values) const;

 private:
  // What stands after psi for one side of a pair: a row of this table, or one-hot.
  struct Side {
    const TensorInfo* table;
    int width;
  };
  int inputs() const { return feature_ + env_.width + task_.width; }
  // [n, inputs()].
  std::vector<float> make_inputs(int n, const float* psi, const int* env, const int* task,
                                 const float* policy_parameters) const;

  int feature_;
  Side env_, task_;
  Layout parameters_;
  Perceptron<float> perceptron_;
  std::vector<float> x_;  // of the last forward()
};

}  // namespace synpo
