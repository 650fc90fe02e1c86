// Successor features: a reward that is linear in features, and their discounted sum.
//
//   r(s, a) = phi(s, a)^T e_task,   sigma(s, a; z) = phi(s, a) + gamma sigma(s', a'; z),   Q_z(s, a) = sigma(s, a; z)^T
//   e_task
// phi is a perceptron over the state's feature psi(s), sigma one over psi(s), e_env and e_task; s' and a' are the next
// state and the expert's action there. The policy takes the action of the highest Q. SfLoss says how sigma is learned.
// Checkpoints call the tensors of sigma "psi", as the literature on successor features does.
#pragma once
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "policy/head/embedding_table.h"
#include "policy/losses.h"
#include "policy/method/encoded_policy.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

template <class T>
class Sf : public EncodedPolicy<T> {
 public:
  explicit Sf(const PolicyShape& shape);

  BatchNeeds needs() const override;
  double temperature() const override { return shape().sf_loss == SfLoss::kCrossEntropy ? kTemperature : 0; }

 protected:
  std::vector<typename Policy<T>::OwnGroup> own_groups() const override;
  void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const override;
  Losses head_step(const HeadStep<T>& step) override;
  void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) override;
  void infer_head(int size, const T* psi, const int* pair, T* logits) const override;

 private:
  using EncodedPolicy<T>::shape;
  int inputs() const { return shape().feature + 2 * shape().embedding; }
  void make_input(const T* feature, int env, int task, T* x) const;
  // values [actions] = features [actions, embedding] w.
  void values(const T* features, const T* w, T* values) const;
  // Mean square of a temporal difference; dsuccessor = its gradient. Targets are held fixed.
  double temporal_difference(const StepBatch<T>& batch, double discount, const T* phi, const T* successor,
                             T* dsuccessor) const;
  // Mean square of Q's distance from the planner's; dq = its gradient.
  double planner_distance(const StepBatch<T>& batch, const T* q, T* dq) const;

  EmbeddingTable<T> env_, task_;
  Perceptron<T> phi_, successor_;
  Buffer<T> x_, dx_, dphi_, dsuccessor_, dq_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class Sf<float>;
extern template class Sf<double>;

}  // namespace synpo
