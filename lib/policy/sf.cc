#include "policy/sf.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernels.h"
#include "policy/head_losses.h"

namespace synpo {

template <class T>
Sf<T>::Sf(const PolicyShape& shape)
    : shape_(shape), encoder_(shape.channels, shape.feature, shape.normalise_input, this->parameters_, this->statistics_),
      behind_encoder_(this->parameters_.total()),
      env_("embedding.env", shape.envs, shape.embedding, shape.normalise_embeddings, this->parameters_),
      task_("embedding.task", shape.tasks, shape.embedding, shape.normalise_embeddings, this->parameters_),
      phi_("phi", shape.feature, shape.head_hidden, shape.actions * shape.embedding, this->parameters_),
      psi_("psi", inputs(), shape.head_hidden, shape.actions * shape.embedding, this->parameters_) {}

template <class T>
BatchNeeds Sf<T>::needs() const {
  return {shape_.sf_loss == SfLoss::kTemporalDifference, shape_.sf_loss == SfLoss::kPlannerQ};
}

template <class T>
void Sf<T>::initialise(const InitOptions& options, T* parameters, T* statistics) const {
  std::fill_n(parameters, this->parameters_.total(), T(0));
  encoder_.initialise(options.seed, parameters, statistics);
  InitStream stream(options.seed, 1);
  env_.initialise(stream, options.embedding_sd, parameters);
  task_.initialise(stream, options.embedding_sd, parameters);
  phi_.initialise(stream, parameters);
  psi_.initialise(stream, parameters);
}

template <class T>
void Sf<T>::make_input(const T* feature, int env, int task, T* x) const {
  x = std::copy_n(feature, shape_.feature, x);
  task_.put(task, env_.put(env, x));
}

template <class T>
void Sf<T>::values(const T* features, const T* w, T* values) const {
  const int width = shape_.embedding;
  for (int a = 0; a < shape_.actions; ++a) values[a] = kernels<T>().dot(width, features + size_t(a) * width, w);
}

template <class T>
double Sf<T>::temporal_difference(const StepBatch<T>& batch, double discount, const T* phi, const T* psi, T* dpsi) const {
  const int n = batch.size, width = shape_.embedding;
  const size_t row = size_t(shape_.actions) * width;
  const auto unknown = std::count(batch.next, batch.next + n, int(StepBatch<T>::kUnknown));
  const double counted = std::max(1.0, double(n - unknown));
  std::fill_n(dpsi, n * row, T(0));
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const int next = batch.next[i];
    if (next == StepBatch<T>::kUnknown) continue;
    const size_t at = i * row + size_t(batch.taken[i]) * width;
    const T* behind = next == StepBatch<T>::kTerminal ? nullptr : psi + next * row + size_t(batch.label[next]) * width;
    for (int c = 0; c < width; ++c) {
      const T target = phi[at + c] + (behind ? T(discount) * behind[c] : T(0));
      const T error = psi[at + c] - target;
      sum += double(error) * error;
      dpsi[at + c] = T(2 * error / (counted * width));
    }
  }
  return sum / (counted * width);
}

template <class T>
double Sf<T>::planner_distance(const StepBatch<T>& batch, const T* q, T* dq) const {
  const size_t count = size_t(batch.size) * shape_.actions;
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    const T error = q[i] - batch.planner_q[i];
    sum += double(error) * error;
    dq[i] = T(2 * error / count);
  }
  return sum / count;
}

template <class T>
Losses Sf<T>::step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics, T* gradient,
                   T* logits) {
  const int n = batch.size, d = shape_.feature, width = shape_.embedding, actions = shape_.actions, in = inputs();
  const size_t row = size_t(actions) * width;
  std::fill(gradient + behind_encoder_, gradient + this->parameters_.total(), T(0));
  T* feature = feature_.grow(size_t(n) * d);
  T* dfeature = dfeature_.grow(size_t(n) * d);
  T* x = x_.grow(size_t(n) * in);
  T* dx = dx_.grow(size_t(n) * in);
  T* dphi = dphi_.grow(n * row);
  T* dpsi = dpsi_.grow(n * row);
  T* dq = dq_.grow(size_t(n) * actions);
  encoder_.forward(parallel, n, batch.pictures, parameters, statistics, feature);
  env_.use(parameters);
  task_.use(parameters);
  for (int i = 0; i < n; ++i) make_input(feature + size_t(i) * d, batch.env[i], batch.task[i], x + size_t(i) * in);
  const T* phi = phi_.forward(parallel, n, feature, parameters);
  const T* psi = psi_.forward(parallel, n, x, parameters);
  for (int i = 0; i < n; ++i) values(psi + i * row, task_.row(batch.task[i]), logits + size_t(i) * actions);

  Losses losses;
  losses.env = losses.task = std::nan("");
  if (shape_.sf_loss == SfLoss::kTemporalDifference) {
    losses.policy = temporal_difference(batch, weights.discount, phi, psi, dpsi);
  } else {
    losses.policy = shape_.sf_loss == SfLoss::kPlannerQ ? planner_distance(batch, logits, dq)
                                                        : policy_loss(parallel, n, actions, logits, batch.label, dq);
    for (int i = 0; i < n; ++i) {
      const T* w = task_.row(batch.task[i]);
      T* dw = task_.gradient_row(batch.task[i]);
      for (int a = 0; a < actions; ++a)
        for (int c = 0; c < width; ++c) {
          const size_t at = i * row + size_t(a) * width + c;
          dpsi[at] = dq[size_t(i) * actions + a] * w[c];
          dw[c] += dq[size_t(i) * actions + a] * psi[at];
        }
    }
  }
  std::fill_n(dphi, n * row, T(0));
  for (int i = 0; i < n; ++i) {
    const size_t at = i * row + size_t(batch.taken[i]) * width;
    const T* w = task_.row(batch.task[i]);
    T* dw = task_.gradient_row(batch.task[i]);
    const T error = kernels<T>().dot(width, phi + at, w) - batch.reward[i];
    losses.reward += double(error) * error / n;
    const T derror = T(weights.reward) * 2 * error / T(n);
    for (int c = 0; c < width; ++c) {
      dphi[at + c] = derror * w[c];
      dw[c] += derror * phi[at + c];
    }
  }
  phi_.backward(parallel, feature, dphi, dfeature, false, parameters, gradient);
  psi_.backward(parallel, x, dpsi, dx, false, parameters, gradient);
  for (int i = 0; i < n; ++i) {
    const T* from = dx + size_t(i) * in;
    for (int c = 0; c < d; ++c) dfeature[size_t(i) * d + c] += *from++;
    task_.add_gradient(batch.task[i], env_.add_gradient(batch.env[i], from));
  }
  env_.backward(parameters, gradient);
  task_.backward(parameters, gradient);
  encoder_.backward(parallel, parameters, dfeature, gradient);
  losses.add_up(weights);
  return losses;
}

template <class T>
void Sf<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics, const std::vector<std::pair<int, int>>& pairs) {
  encoder_.prepare_inference(parallel, parameters, statistics);
  env_.use(parameters);
  task_.use(parameters);
  psi_.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void Sf<T>::infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) {
  const int d = shape_.feature, in = inputs();
  const size_t row = size_t(shape_.actions) * shape_.embedding;
  std::vector<T> feature(size_t(size) * d), x(size_t(size) * in), psi(size * row);
  Buffer<T> scratch;
  encoder_.infer(thread, size, pictures, feature.data());
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    make_input(feature.data() + size_t(i) * d, env, task, x.data() + size_t(i) * in);
  }
  psi_.infer(size, x.data(), psi.data(), scratch);
  for (int i = 0; i < size; ++i) values(psi.data() + i * row, task_.row(pairs_[pair[i]].second), logits + size_t(i) * shape_.actions);
}

template class Sf<float>;
template class Sf<double>;

}  // namespace synpo
