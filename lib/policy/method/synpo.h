// SynPo: policies synthesised from environment and task embeddings over a shared basis.
//
//   U(z) = sum_k alpha_k(z) Theta_k,  V(z) = sum_k beta_k(z) Theta_k,  z = (env, task)
//   pi_z(a|s) = softmax_a(psi(s)^T U(z) phi(a) + b_a),   r_z(s, a) = psi(s)^T V(z) phi(a) + c_a
//   x(s, a)_k = psi(s)^T Theta_k phi(a);   the environment is recognised by f_env(x)^T e_env, the task from f_task(x)^T
//   e_task
//
// alpha, beta, f_env and f_task are dense layers with one hidden ReLU layer (Sections 4.1 and 4.3); theta and phi:
// bilinear_form.h. The multi-task baseline (MTL) is the same without the environment: z = task, and the environment's
// loss and embeddings are left out.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "policy/embedding_loss.h"
#include "policy/head/bilinear_form.h"
#include "policy/head/embedding_table.h"
#include "policy/head/groups.h"
#include "policy/head/recogniser.h"
#include "policy/losses.h"
#include "policy/method/encoded_policy.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

template <class T>
class SynPo : public EncodedPolicy<T> {
 public:
  enum class Context { kEnvAndTask, kTask };  // what coefficients are made from
  explicit SynPo(const PolicyShape& shape, Context context = Context::kEnvAndTask);

  std::unique_ptr<EmbeddingLoss> embedding_loss(const T* parameters, const std::vector<bool>& new_env,
                                                const std::vector<bool>& new_task, bool recognisers) const override;
  size_t embedding_loss_step_bytes() const override;

 protected:
  std::vector<typename Policy<T>::OwnGroup> own_groups() const override;
  void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const override;
  Losses head_step(const HeadStep<T>& step) override;
  void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) override;
  void infer_head(int size, const T* psi, const int* pair, T* logits) const override;

 private:
  friend class SynPoEmbeddingLoss;  // which takes its parts over
  enum Head { kPolicy, kReward, kHeads };
  using EncodedPolicy<T>::shape;
  int coefficient_inputs() const { return (env_ ? 2 : 1) * shape().embedding; }
  void use_embeddings(const T* parameters);
  void compose(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs);
  void compose_backward(Parallel& parallel, const T* parameters, T* gradient);
  Losses heads(const HeadStep<T>& step);
  void disentangle(const HeadStep<T>& step, Losses& losses);

  std::optional<EmbeddingTable<T>> env_;
  EmbeddingTable<T> task_;
  Perceptron<T> coefficient_[kHeads];  // alpha, beta
  BilinearForm<T> form_;
  size_t bias_[kHeads];
  std::optional<Recogniser<T>> f_env_;
  Recogniser<T> f_task_;

  // Samples by pair and by the expert's action.
  Groups by_pair_, by_label_;
  // Per distinct pair: inputs of alpha and beta, and what they compose: U and V [pairs, columns, d].
  std::vector<std::pair<int, int>> pairs_;
  const T* coefficients_[kHeads];
  Buffer<T> pair_input_, dpair_input_, dcoefficients_, composed_[kHeads], dcomposed_[kHeads];
  // Per sample.
  Buffer<T> q_[kHeads], dq_[kHeads], dlogits_, psi_sorted_, dpsi_sorted_, x_, dx_;
  std::vector<int> truth_;
  // For inference.
  std::vector<T> policy_bias_;
};

extern template class SynPo<float>;
extern template class SynPo<double>;

}  // namespace synpo
