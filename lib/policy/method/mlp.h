// The MLP baseline: one network for all pairs, told which by its input.
//
//   x = [psi / |psi|, e_env, e_task];  scores of the actions and their rewards each by a perceptron over x.
//   The environment is recognised by f_env(psi / |psi|)^T e_env, the task from f_task(psi / |psi|)^T e_task.
#pragma once
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "policy/head/embedding_table.h"
#include "policy/head/recogniser.h"
#include "policy/losses.h"
#include "policy/method/encoded_policy.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

template <class T>
class Mlp : public EncodedPolicy<T> {
 public:
  explicit Mlp(const PolicyShape& shape);

 protected:
  std::vector<typename Policy<T>::OwnGroup> own_groups() const override;
  void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const override;
  Losses head_step(const HeadStep<T>& step) override;
  void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) override;
  void infer_head(int size, const T* psi, const int* pair, T* logits) const override;

 private:
  using EncodedPolicy<T>::shape;
  int inputs() const { return shape().feature + 2 * shape().embedding; }
  // One row of x from a state's psi; returns 1 / |psi|.
  double make_input(const T* psi, int env, int task, T* x) const;

  EmbeddingTable<T> env_, task_;
  Perceptron<T> policy_, reward_;
  Recogniser<T> f_env_, f_task_;

  Buffer<T> x_, dx_, unit_, dunit_, dlogits_, drewards_;
  std::vector<double> factor_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class Mlp<float>;
extern template class Mlp<double>;

}  // namespace synpo
