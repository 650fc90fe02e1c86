// The MLP baseline: one network for all pairs, told which by its input.
//
//   x = [psi / |psi|, e_env, e_task];  scores of the actions and their rewards each by a perceptron over x.
//   The environment is told from f_env(psi / |psi|)^T e_env, the task from f_task(psi / |psi|)^T e_task.
#pragma once
#include "nn/perceptron.h"
#include "policy/embedding_table.h"
#include "policy/policy.h"
#include "policy/recogniser.h"
#include "policy/resnet.h"

namespace synpo {

template <class T>
class Mlp : public Policy<T> {
 public:
  explicit Mlp(const PolicyShape& shape);

  void initialise(const InitOptions& options, T* parameters, T* statistics) const override;
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics, T* gradient,
              T* logits) override;
  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override;
  void infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) override;

 private:
  int inputs() const { return shape_.feature + 2 * shape_.embedding; }
  // One row of x from a state's psi; returns 1 / |psi|.
  double make_input(const T* psi, int env, int task, T* x) const;

  PolicyShape shape_;
  ResNet<T> encoder_;
  size_t behind_encoder_;  // where the other parameters begin
  EmbeddingTable<T> env_, task_;
  Perceptron<T> policy_, reward_;
  Recogniser<T> f_env_, f_task_;

  Buffer<T> psi_, x_, dx_, unit_, dunit_, dlogits_, drewards_;
  std::vector<double> factor_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class Mlp<float>;
extern template class Mlp<double>;

}  // namespace synpo
