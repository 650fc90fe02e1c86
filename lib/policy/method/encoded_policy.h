// All methods share this: first an encoder, which gives psi(s), then a head, which is the method's own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "policy/encoder/encoder.h"
#include "policy/losses.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

// The part of a training step after the encoder: what it reads and where it writes.
template <class T>
struct HeadStep {
  Parallel& parallel;
  const StepBatch<T>& batch;
  const StepOptions& options;
  const T* parameters;
  const T* psi;  // [size, feature]
  T* logits;     // [size, actions]; overwritten
  T* dpsi;       // added to, as the gradient is: zero, or what others have added
  T* gradient;
};

template <class T>
class EncodedPolicy : public Policy<T> {
 public:
  explicit EncodedPolicy(const PolicyShape& shape);

  Losses step(Parallel& parallel, const StepBatch<T>& batch, const StepOptions& options, const T* parameters,
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

  // The head's parameters; all are zero before.
  virtual void initialise_head(InitStream& stream, double embedding_sd, T* parameters) const = 0;
  // Forward and backward from psi.
  virtual Losses head_step(const HeadStep<T>& step) = 0;
  virtual void prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) = 0;
  virtual void infer_head(int size, const T* psi, const int* pair, T* logits) const = 0;

  // The loss of the step's logits, the batch's objective or cross-entropy against its labels: dlogits =, dpsi +=.
  double score_loss(const HeadStep<T>& step, T* dlogits) const;

 private:
  PolicyShape shape_;
  std::unique_ptr<Encoder<T>> encoder_;
  size_t head_begin_;  // where the head's parameters begin
  Buffer<T> psi_, dpsi_;
};

extern template class EncodedPolicy<float>;
extern template class EncodedPolicy<double>;

}  // namespace synpo
