// Successor features: a reward that is linear in features, and their discounted sum.
//
//   r(s, a) = phi(s, a)^T e_task,   psi(s, a; z) = phi(s, a) + gamma psi(s', a'; z),   Q_z(s, a) = psi(s, a; z)^T e_task
// phi is a perceptron over the state's feature, psi one over the feature, e_env and e_task; s' and a' are the next state and the
// expert's action there. The policy takes the action of the highest Q. What psi is learned from: SfLoss.
#pragma once
#include "nn/perceptron.h"
#include "policy/embedding_table.h"
#include "policy/policy.h"
#include "policy/resnet.h"

namespace synpo {

template <class T>
class Sf : public Policy<T> {
 public:
  explicit Sf(const PolicyShape& shape);

  BatchNeeds needs() const override;
  double temperature() const override { return shape_.sf_loss == SfLoss::kCrossEntropy ? kTemperature : 0; }
  void initialise(const InitOptions& options, T* parameters, T* statistics) const override;
  // Losses::policy is the loss that psi is learned from.
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics, T* gradient,
              T* logits) override;
  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override;
  void infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) override;

 private:
  int inputs() const { return shape_.feature + 2 * shape_.embedding; }
  void make_input(const T* feature, int env, int task, T* x) const;
  // values [actions] = features [actions, embedding] w.
  void values(const T* features, const T* w, T* values) const;
  // Mean square of a temporal difference; dpsi = its gradient. Targets are held fixed.
  double temporal_difference(const StepBatch<T>& batch, double discount, const T* phi, const T* psi, T* dpsi) const;
  // Mean square of Q's distance from the planner's; dq = its gradient.
  double planner_distance(const StepBatch<T>& batch, const T* q, T* dq) const;

  PolicyShape shape_;
  ResNet<T> encoder_;
  size_t behind_encoder_;  // where the other parameters begin
  EmbeddingTable<T> env_, task_;
  Perceptron<T> phi_, psi_;
  Buffer<T> feature_, dfeature_, x_, dx_, dphi_, dpsi_, dq_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class Sf<float>;
extern template class Sf<double>;

}  // namespace synpo
