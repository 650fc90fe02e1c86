// ModuleNet (Devin et al. 2017): a perceptron for every task and one for every environment, put together where they meet.
//
//   scores = module_env(dropout(module_task(psi)));  psi [d] -> hidden -> seam of the task's, seam -> hidden -> actions of the environment's.
// It has the imitation loss alone. Samples of a batch are grouped by module.
#pragma once
#include "nn/perceptron.h"
#include "policy/groups.h"
#include "policy/policy.h"
#include "policy/resnet.h"

namespace synpo {

template <class T>
class ModuleNet : public Policy<T> {
 public:
  explicit ModuleNet(const PolicyShape& shape);

  void initialise(const InitOptions& options, T* parameters, T* statistics) const override;
  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics, T* gradient,
              T* logits) override;
  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                         const std::vector<std::pair<int, int>>& pairs) override;
  void infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) override;

 private:
  // One module for each key, over the samples of that key.
  struct Modules {
    std::vector<Perceptron<T>> each;
    Groups groups;
    Buffer<T> x, dx, dy;  // samples sorted by key
    void forward(Parallel& parallel, const T* from, const T* parameters, T* to);
    void backward(Parallel& parallel, const T* dto, T* dfrom, const T* parameters, T* gradient);
  };

  PolicyShape shape_;
  ResNet<T> encoder_;
  size_t behind_encoder_;  // where the other parameters begin
  Modules task_, env_;
  Buffer<T> psi_, dpsi_, seam_, dseam_, keep_, dlogits_;
  std::vector<std::pair<int, int>> pairs_;  // for inference
};

extern template class ModuleNet<float>;
extern template class ModuleNet<double>;

}  // namespace synpo
