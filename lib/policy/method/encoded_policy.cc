#include "policy/method/encoded_policy.h"

#include <algorithm>

#include "nn/layout.h"
#include "policy/encoder/resnet.h"
#include "policy/encoder/temporal_net.h"
#include "policy/head/head_losses.h"
#include "world/observation.h"

namespace synpo {
namespace {

template <class T>
std::unique_ptr<Encoder<T>> make_encoder(const PolicyShape& shape, Layout& parameters, Layout& statistics) {
  if (shape.observation.sight == Sight::kFeatures)
    return std::make_unique<TemporalNet<T>>(shape.observation, shape.views, shape.feature, parameters);
  return std::make_unique<ResNet<T>>(shape.observation, shape.channels, shape.feature, shape.normalise_input,
                                     parameters, statistics);
}

}  // namespace

template <class T>
EncodedPolicy<T>::EncodedPolicy(const PolicyShape& shape)
    : shape_(shape), encoder_(make_encoder<T>(shape, this->parameters_, this->statistics_)),
      head_begin_(this->parameters_.total()) {}

template <class T>
void EncodedPolicy<T>::initialise(const InitOptions& options, T* parameters, T* statistics) const {
  std::fill_n(parameters, this->parameters_.total(), T(0));
  encoder_->initialise(options.seed, parameters, statistics);
  InitStream stream(options.seed, 1);
  initialise_head(stream, options.embedding_sd, parameters);
}

template <class T>
Losses EncodedPolicy<T>::step(Parallel& parallel, const StepBatch<T>& batch, const StepOptions& options,
                              const T* parameters, T* statistics, T* gradient, T* logits) {
  const size_t size = size_t(batch.size) * shape_.feature;
  constexpr size_t kPart = 1 << 16;
  const size_t head = this->parameters_.total() - head_begin_;
  parallel.run(int((head + kPart - 1) / kPart), [&](int shard, int) {
    std::fill_n(gradient + head_begin_ + shard * kPart, std::min(kPart, head - shard * kPart), T(0));
  });
  T* dpsi = dpsi_.grow(size);
  std::fill_n(dpsi, size, T(0));
  if (batch.psi)
    std::copy_n(batch.psi, size, psi_.grow(size));
  else
    encoder_->forward(parallel, batch.size, batch.observations, parameters, statistics, psi_.grow(size),
                      batch.frozen_statistics);
  Losses losses = head_step({parallel, batch, options, parameters, psi_.data(), logits, dpsi, gradient});
  if (!batch.psi) encoder_->backward(parallel, parameters, dpsi, gradient);
  losses.add_up(options.weights);
  return losses;
}

template <class T>
double EncodedPolicy<T>::score_loss(const HeadStep<T>& step, T* dlogits) const {
  const StepBatch<T>& batch = step.batch;
  if (batch.objective)
    return batch.objective->apply(step.parallel, batch.size, step.psi, step.logits, dlogits, step.dpsi);
  return policy_loss(step.parallel, batch.size, shape_.actions, step.logits, batch.label, dlogits);
}

template <class T>
void EncodedPolicy<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                                         const std::vector<std::pair<int, int>>& pairs) {
  encoder_->prepare_inference(parallel, parameters, statistics);
  prepare_head(parallel, parameters, pairs);
}

template <class T>
void EncodedPolicy<T>::infer(int thread, int size, const uint8_t* observations, const int* pair, T* logits, T* psi) {
  std::vector<T> own(psi ? 0 : size_t(size) * shape_.feature);
  if (!psi) psi = own.data();
  encoder_->infer(thread, size, observations, psi);
  infer_head(size, psi, pair, logits);
}

template class EncodedPolicy<float>;
template class EncodedPolicy<double>;

}  // namespace synpo
