#include "policy/method/mlp.h"

#include <algorithm>
#include <cstddef>

#include "nn/unit_norm.h"
#include "policy/head/head_losses.h"

namespace synpo {

template <class T>
Mlp<T>::Mlp(const PolicyShape& shape)
    : EncodedPolicy<T>(shape),
      env_("embedding.env", shape.envs, shape.embedding, shape.normalise_embeddings, this->parameters_),
      task_("embedding.task", shape.tasks, shape.embedding, shape.normalise_embeddings, this->parameters_),
      policy_("policy", inputs(), shape.head_hidden, shape.actions, this->parameters_),
      reward_("reward", inputs(), shape.head_hidden, shape.actions, this->parameters_),
      f_env_("f_env", shape.feature, shape.hidden, env_, this->parameters_),
      f_task_("f_task", shape.feature, shape.hidden, task_, this->parameters_) {}

template <class T>
std::vector<typename Policy<T>::OwnGroup> Mlp<T>::own_groups() const {
  return {{ParameterGroup::kRecognisers, {"f_env.", "f_task."}}, {ParameterGroup::kHeads, {"policy.", "reward."}}};
}

template <class T>
void Mlp<T>::initialise_head(InitStream& stream, double embedding_sd, T* parameters) const {
  env_.initialise(stream, embedding_sd, parameters);
  task_.initialise(stream, embedding_sd, parameters);
  policy_.initialise(stream, parameters);
  reward_.initialise(stream, parameters);
  f_env_.initialise(stream, parameters);
  f_task_.initialise(stream, parameters);
}

template <class T>
double Mlp<T>::make_input(const T* psi, int env, int task, T* x) const {
  const double factor = length_factor(psi, shape().feature, 1);
  x = std::transform(psi, psi + shape().feature, x, [&](T value) { return T(factor * value); });
  task_.put(task, env_.put(env, x));
  return factor;
}

template <class T>
Losses Mlp<T>::head_step(const HeadStep<T>& step) {
  const auto& [parallel, batch, options, parameters, psi, logits, dpsi, gradient] = step;
  const LossWeights& weights = options.weights;
  const int n = batch.size, d = shape().feature, actions = shape().actions, in = inputs();
  factor_.resize(n);
  T* x = x_.grow(size_t(n) * in);
  T* dx = dx_.grow(size_t(n) * in);
  T* unit = unit_.grow(size_t(n) * d);
  T* dunit = dunit_.grow(size_t(n) * d);
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
  losses.policy = this->score_loss(step, dlogits);
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
  for (int i = 0; i < n; ++i) {
    T* row = dunit + size_t(i) * d;
    length_backward(unit + size_t(i) * d, d, 1, factor_[i], row);
    for (int c = 0; c < d; ++c) dpsi[size_t(i) * d + c] += row[c];
  }
  return losses;
}

template <class T>
void Mlp<T>::prepare_head(Parallel&, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  env_.use(parameters);
  task_.use(parameters);
  policy_.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void Mlp<T>::infer_head(int size, const T* psi, const int* pair, T* logits) const {
  const int d = shape().feature, in = inputs();
  std::vector<T> x(size_t(size) * in);
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    make_input(psi + size_t(i) * d, env, task, x.data() + size_t(i) * in);
  }
  Buffer<T> scratch;
  policy_.infer(size, x.data(), logits, scratch);
}

template class Mlp<float>;
template class Mlp<double>;

}  // namespace synpo
