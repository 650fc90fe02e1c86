// ModuleNet (Devin et al. 2017): a perceptron for every task and one for every environment, put together where they
// meet.
//
//   scores = module_env(dropout(module_task(psi)));  psi [d] -> hidden -> seam of the task's, seam -> hidden -> actions
//   of the environment's.
// It has the imitation loss alone. Samples of a batch are grouped by module.
#pragma once
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "policy/head/groups.h"
#include "policy/losses.h"
#include "policy/method/encoded_policy.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

template <class T>
class ModuleNet : public EncodedPolicy<T> {
 public:
  explicit ModuleNet(const PolicyShape& shape);

  std::vector<T> dropout_factors(const StepBatch<T>& batch, const StepOptions& options) const override;

 protected:
  std::vector<typename Policy<T>::OwnGroup> own_groups() const override;
  void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const override;
  Losses head_step(const HeadStep<T>& step) override;
  void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) override;
  void infer_head(int size, const T* psi, const int* pair, T* logits) const override;

 private:
  using EncodedPolicy<T>::shape;
  // One module for each key, over the samples of that key.
  struct Modules {
    std::vector<Perceptron<T>> each;
    Groups groups;
    Buffer<T> x, dx, dy;  // samples sorted by key
    void forward(Parallel& parallel, const T* from, const T* parameters, T* to);
    void backward(Parallel& parallel, const T* dto, T* dfrom, const T* parameters, T* gradient);
  };

  Modules task_, env_;
  Buffer<T> seam_, dseam_, dlogits_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class ModuleNet<float>;
extern template class ModuleNet<double>;

}  // namespace synpo
