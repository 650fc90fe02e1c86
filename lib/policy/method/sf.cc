#include "policy/method/sf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernel/kernels.h"

namespace synpo {

template <class T>
Sf<T>::Sf(const PolicyShape& shape)
    : EncodedPolicy<T>(shape),
      env_("embedding.env", shape.envs, shape.embedding, shape.normalise_embeddings, this->parameters_),
      task_("embedding.task", shape.tasks, shape.embedding, shape.normalise_embeddings, this->parameters_),
      phi_("phi", shape.feature, shape.head_hidden, shape.actions * shape.embedding, this->parameters_),
      successor_("psi", inputs(), shape.head_hidden, shape.actions * shape.embedding, this->parameters_) {}

template <class T>
BatchNeeds Sf<T>::needs() const {
  return {shape().sf_loss == SfLoss::kTemporalDifference, shape().sf_loss == SfLoss::kPlannerQ};
}

template <class T>
std::vector<typename Policy<T>::OwnGroup> Sf<T>::own_groups() const {
  return {{ParameterGroup::kHeads, {"phi.", "psi."}}};
}

template <class T>
void Sf<T>::initialise_head(InitStream& stream, double embedding_sd, T* parameters) const {
  env_.initialise(stream, embedding_sd, parameters);
  task_.initialise(stream, embedding_sd, parameters);
  phi_.initialise(stream, parameters);
  successor_.initialise(stream, parameters);
}

template <class T>
void Sf<T>::make_input(const T* feature, int env, int task, T* x) const {
  x = std::copy_n(feature, shape().feature, x);
  task_.put(task, env_.put(env, x));
}

template <class T>
void Sf<T>::values(const T* features, const T* w, T* values) const {
  const int width = shape().embedding;
  for (int a = 0; a < shape().actions; ++a) values[a] = kernels<T>().dot(width, features + size_t(a) * width, w);
}

template <class T>
double Sf<T>::temporal_difference(const StepBatch<T>& batch, double discount, const T* phi, const T* successor,
                                  T* dsuccessor) const {
  const int n = batch.size, width = shape().embedding;
  const size_t row = size_t(shape().actions) * width;
  const auto unknown = std::count(batch.next, batch.next + n, int(StepBatch<T>::kUnknown));
  const double counted = std::max(1.0, double(n - unknown));
  std::fill_n(dsuccessor, n * row, T(0));
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const int next = batch.next[i];
    if (next == StepBatch<T>::kUnknown) continue;
    const size_t at = i * row + size_t(batch.taken[i]) * width;
    const T* following =
        next == StepBatch<T>::kTerminal ? nullptr : successor + next * row + size_t(batch.label[next]) * width;
    for (int c = 0; c < width; ++c) {
      const T target = phi[at + c] + (following ? T(discount) * following[c] : T(0));
      const T error = successor[at + c] - target;
      sum += double(error) * error;
      dsuccessor[at + c] = T(2 * error / (counted * width));
    }
  }
  return sum / (counted * width);
}

template <class T>
double Sf<T>::planner_distance(const StepBatch<T>& batch, const T* q, T* dq) const {
  const size_t count = size_t(batch.size) * shape().actions;
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    const T error = q[i] - batch.planner_q[i];
    sum += double(error) * error;
    dq[i] = T(2 * error / count);
  }
  return sum / count;
}

template <class T>
Losses Sf<T>::head_step(const HeadStep<T>& step) {
  const auto& [parallel, batch, options, parameters, feature, logits, dfeature, gradient] = step;
  const int n = batch.size, d = shape().feature, width = shape().embedding, actions = shape().actions, in = inputs();
  const size_t row = size_t(actions) * width;
  T* x = x_.grow(size_t(n) * in);
  T* dx = dx_.grow(size_t(n) * in);
  T* dphi = dphi_.grow(n * row);
  T* dsuccessor = dsuccessor_.grow(n * row);
  T* dq = dq_.grow(size_t(n) * actions);
  env_.use(parameters);
  task_.use(parameters);
  for (int i = 0; i < n; ++i) make_input(feature + size_t(i) * d, batch.env[i], batch.task[i], x + size_t(i) * in);
  const T* phi = phi_.forward(parallel, n, feature, parameters);
  const T* successor = successor_.forward(parallel, n, x, parameters);
  for (int i = 0; i < n; ++i) values(successor + i * row, task_.row(batch.task[i]), logits + size_t(i) * actions);

  Losses losses;
  losses.env = losses.task = std::nan("");
  if (shape().sf_loss == SfLoss::kTemporalDifference && !batch.objective) {
    losses.policy = temporal_difference(batch, options.discount, phi, successor, dsuccessor);
  } else {
    losses.policy = shape().sf_loss == SfLoss::kPlannerQ && !batch.objective ? planner_distance(batch, logits, dq)
                                                                             : this->score_loss(step, dq);
    for (int i = 0; i < n; ++i) {
      const T* w = task_.row(batch.task[i]);
      T* dw = task_.gradient_row(batch.task[i]);
      for (int a = 0; a < actions; ++a)
        for (int c = 0; c < width; ++c) {
          const size_t at = i * row + size_t(a) * width + c;
          dsuccessor[at] = dq[size_t(i) * actions + a] * w[c];
          dw[c] += dq[size_t(i) * actions + a] * successor[at];
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
    const T derror = T(options.weights.reward) * 2 * error / T(n);
    for (int c = 0; c < width; ++c) {
      dphi[at + c] = derror * w[c];
      dw[c] += derror * phi[at + c];
    }
  }
  phi_.backward(parallel, feature, dphi, dfeature, true, parameters, gradient);
  successor_.backward(parallel, x, dsuccessor, dx, false, parameters, gradient);
  for (int i = 0; i < n; ++i) {
    const T* from = dx + size_t(i) * in;
    for (int c = 0; c < d; ++c) dfeature[size_t(i) * d + c] += *from++;
    task_.add_gradient(batch.task[i], env_.add_gradient(batch.env[i], from));
  }
  env_.backward(parameters, gradient);
  task_.backward(parameters, gradient);
  return losses;
}

template <class T>
void Sf<T>::prepare_head(Parallel&, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  env_.use(parameters);
  task_.use(parameters);
  successor_.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void Sf<T>::infer_head(int size, const T* feature, const int* pair, T* logits) const {
  const int d = shape().feature, in = inputs();
  const size_t row = size_t(shape().actions) * shape().embedding;
  std::vector<T> x(size_t(size) * in), successor(size * row);
  Buffer<T> scratch;
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    make_input(feature + size_t(i) * d, env, task, x.data() + size_t(i) * in);
  }
  successor_.infer(size, x.data(), successor.data(), scratch);
  for (int i = 0; i < size; ++i)
    values(successor.data() + i * row, task_.row(pairs_[pair[i]].second), logits + size_t(i) * shape().actions);
}

template class Sf<float>;
template class Sf<double>;

}  // namespace synpo
