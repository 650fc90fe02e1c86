#include "policy/mlp.h"

#include <algorithm>

#include "nn/length.h"
#include "policy/head_losses.h"

namespace synpo {

template <class T>
Mlp<T>::Mlp(const PolicyShape& shape)
    : shape_(shape), encoder_(shape.channels, shape.feature, shape.normalise_input, this->parameters_, this->statistics_),
      behind_encoder_(this->parameters_.total()),
      env_("embedding.env", shape.envs, shape.embedding, shape.normalise_embeddings, this->parameters_),
      task_("embedding.task", shape.tasks, shape.embedding, shape.normalise_embeddings, this->parameters_),
      policy_("policy", inputs(), shape.head_hidden, shape.actions, this->parameters_),
      reward_("reward", inputs(), shape.head_hidden, shape.actions, this->parameters_),
      f_env_("f_env", shape.feature, shape.hidden, env_, this->parameters_),
      f_task_("f_task", shape.feature, shape.hidden, task_, this->parameters_) {}

template <class T>
void Mlp<T>::initialise(const InitOptions& options, T* parameters, T* statistics) const {
  std::fill_n(parameters, this->parameters_.total(), T(0));
  encoder_.initialise(options.seed, parameters, statistics);
  InitStream stream(options.seed, 1);
  env_.initialise(stream, options.embedding_sd, parameters);
  task_.initialise(stream, options.embedding_sd, parameters);
  policy_.initialise(stream, parameters);
  reward_.initialise(stream, parameters);
  f_env_.initialise(stream, parameters);
  f_task_.initialise(stream, parameters);
}

template <class T>
double Mlp<T>::make_input(const T* psi, int env, int task, T* x) const {
  const double factor = length_factor(psi, shape_.feature, 1);
  x = std::transform(psi, psi + shape_.feature, x, [&](T value) { return T(factor * value); });
  task_.put(task, env_.put(env, x));
  return factor;
}

template <class T>
Losses Mlp<T>::step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics,
                    T* gradient, T* logits) {
  const int n = batch.size, d = shape_.feature, actions = shape_.actions, in = inputs();
  std::fill(gradient + behind_encoder_, gradient + this->parameters_.total(), T(0));
  T* psi = psi_.grow(size_t(n) * d);
  factor_.resize(n);
  T* x = x_.grow(size_t(n) * in);
  T* dx = dx_.grow(size_t(n) * in);
  T* unit = unit_.grow(size_t(n) * d);
  T* dunit = dunit_.grow(size_t(n) * d);
  encoder_.forward(parallel, n, batch.pictures, parameters, statistics, psi);
  env_.use(parameters);
  task_.use(parameters);
  for (int i = 0; i < n; ++i) {
    factor_[i] = make_input(psi + size_t(i) * d, batch.env[i], batch.task[i], x + size_t(i) * in);
    std::copy_n(x + size_t(i) * in, d, unit + size_t(i) * d);
  }
  std::copy_n(policy_.forward(parallel, n, x, parameters), size_t(n) * actions, logits);
  const T* rewards = reward_.forward(parallel, n, x, parameters);
  T* dlogits = dlogits_.grow(size_t(n) * actions);
  T* drewards = drewards_.grow(size_t(n) * actions);
  Losses losses;
  losses.policy = policy_loss(parallel, n, actions, logits, batch.label, dlogits);
  losses.reward = reward_loss(n, actions, rewards, batch.taken, batch.reward, weights.reward, drewards);
  policy_.backward(parallel, x, dlogits, dx, false, parameters, gradient);
  reward_.backward(parallel, x, drewards, dx, true, parameters, gradient);
  for (int i = 0; i < n; ++i) {
    const T* row = dx + size_t(i) * in;
    std::copy_n(row, d, dunit + size_t(i) * d);
    task_.add_gradient(batch.task[i], env_.add_gradient(batch.env[i], row + d));
  }
  losses.env = f_env_.step(parallel, n, unit, batch.env, env_, weights.env, parameters, dunit, gradient);
  losses.task = f_task_.step(parallel, n, unit, batch.task, task_, weights.task, parameters, dunit, gradient);
  env_.backward(parameters, gradient);
  task_.backward(parameters, gradient);
  for (int i = 0; i < n; ++i) length_backward(unit + size_t(i) * d, d, 1, factor_[i], dunit + size_t(i) * d);
  encoder_.backward(parallel, parameters, dunit, gradient);
  losses.add_up(weights);
  return losses;
}

template <class T>
void Mlp<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics, const std::vector<std::pair<int, int>>& pairs) {
  encoder_.prepare_inference(parallel, parameters, statistics);
  env_.use(parameters);
  task_.use(parameters);
  policy_.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void Mlp<T>::infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) {
  const int d = shape_.feature, in = inputs();
  std::vector<T> psi(size_t(size) * d), x(size_t(size) * in);
  encoder_.infer(thread, size, pictures, psi.data());
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    make_input(psi.data() + size_t(i) * d, env, task, x.data() + size_t(i) * in);
  }
  Buffer<T> scratch;
  policy_.infer(size, x.data(), logits, scratch);
}

template class Mlp<float>;
template class Mlp<double>;

}  // namespace synpo
