// SynPo: policies synthesised from environment and task embeddings over a shared basis.
//
//   U(z) = sum_k alpha_k(z) Theta_k,  V(z) = sum_k beta_k(z) Theta_k,  z = (env, task)
//   pi_z(a|s) = softmax_a(psi(s)^T U(z) phi(a) + b_a),   r_z(s, a) = psi(s)^T V(z) phi(a) + c_a
//   x(s, a)_k = psi(s)^T Theta_k phi(a);   the environment is told from f_env(x)^T e_env, the task from f_task(x)^T e_task
//
// Theta phi(a) is one tensor [A, d, K], the direct form of the supplement's Section 4.1; alpha, beta, f_env and f_task are dense
// layers with one hidden ReLU layer (Sections 4.1 and 4.3).
#pragma once
#include <utility>
#include <vector>

#include "policy/policy.h"
#include "policy/resnet.h"

namespace synpo {

// in -> hidden ReLU -> out.
struct MlpPlace {
  int in, hidden, out;
  size_t hidden_weight, hidden_bias, out_weight, out_bias;
};

template <class T>
class SynPo : public Policy<T> {
 public:
  explicit SynPo(const PolicyShape& shape);

  void initialise(const InitOptions& options, T* parameters, T* statistics) const override;
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics, T* gradient,
              T* logits) override;
  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override;
  void infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) override;

  const ResNet<T>& encoder() const { return encoder_; }
  // psi of the last step(), [size, feature].
  const T* last_feature() const { return psi_.data(); }

 private:
  MlpPlace add_mlp(const std::string& name, int in, int out);
  void use_embeddings(const T* parameters);
  void compose(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs);
  void group(const StepBatch<T>& batch);
  Losses pairs_forward_backward(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters,
                                T* gradient, T* logits);
  void compose_backward(Parallel& parallel, const T* parameters, T* gradient);
  void disentangle(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* gradient,
                   Losses& losses);
  double recognise(Parallel& parallel, const StepBatch<T>& batch, const MlpPlace& mlp, const int* truth, int classes, const T* embeddings,
                   T* dembeddings, double weight, const T* parameters, T* gradient);
  void embeddings_backward(const T* parameters, T* gradient);

  PolicyShape shape_;
  ResNet<T> encoder_;
  size_t env_, task_, theta_, policy_bias_, reward_bias_;
  MlpPlace alpha_, beta_, f_env_, f_task_;

  // Embeddings as used (normalised where asked), and their gradients.
  std::vector<T> env_used_, task_used_, denv_, dtask_;

  // Distinct pairs of the batch; samples of one pair and of one label together.
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> pair_of_, pair_begin_, by_pair_, label_begin_, by_label_;

  // Per distinct pair: inputs and activations of alpha (0) and beta (1), and what they compose: U and V [pairs, A, d].
  Buffer<T> pair_input_, dpair_input_, hidden_[2], dhidden_[2], coefficients_[2], dcoefficients_[2], composed_[2], dcomposed_[2];
  // Per sample.
  Buffer<T> psi_, dpsi_, psi_sorted_, dpsi_sorted_, x_, dx_, f_hidden_, df_hidden_, f_, df_, scores_, dscores_;
  std::vector<T> inference_bias_;
};

extern template class SynPo<float>;
extern template class SynPo<double>;

}  // namespace synpo
