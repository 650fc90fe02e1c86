// What all methods share: the encoder in front, which gives psi(s), and the part behind it, which is the method's own.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "nn/buffer.h"
#include "nn/init.h"
#include "policy/encoder/encoder.h"
#include "policy/policy.h"

namespace synpo {

template <class T>
class EncodedPolicy : public Policy<T> {
 public:
  explicit EncodedPolicy(const PolicyShape& shape);

  Losses step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters,
              T* statistics, T* gradient, T* logits) final;
  void initialise(const InitOptions& options, T* parameters, T* statistics) const final;
  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                         const std::vector<std::pair<int, int>>& pairs) final;
  void infer(int thread, int size, const uint8_t* observations, const int* pair, T* logits, T* psi) final;

  size_t observation_size() const final { return encoder_->observation_size(); }
  const Encoder<T>& encoder() const { return *encoder_; }
  // psi of the last step(), [size, feature].
  const T* last_feature() const { return psi_.data(); }

 protected:
  const PolicyShape& shape() const { return shape_; }

  // The parameters behind the encoder; all are zero before.
  virtual void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const = 0;
  // Forward and backward from psi [size, feature]: logits and losses; dpsi += and gradient +=, which are zero or what
  // others have added.
  virtual Losses head_step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights,
                           const T* parameters, const T* psi, T* logits, T* dpsi, T* gradient) = 0;
  virtual void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) = 0;
  virtual void infer_head(int size, const T* psi, const int* pair, T* logits) const = 0;

  // The loss of the scores, the batch's objective or cross-entropy against its labels: dlogits =, dpsi +=.
  double score_loss(Parallel& parallel, const StepBatch<T>& batch, const T* psi, const T* logits, T* dlogits,
                    T* dpsi) const;

 private:
  PolicyShape shape_;
  std::unique_ptr<Encoder<T>> encoder_;
  size_t behind_encoder_;  // where the head's parameters begin
  Buffer<T> psi_, dpsi_;
};

extern template class EncodedPolicy<float>;
extern template class EncodedPolicy<double>;

}  // namespace synpo
