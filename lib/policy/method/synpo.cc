#include "policy/method/synpo.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "kernel/kernels.h"
#include "nn/gemm.h"
#include "policy/method/synpo_embedding_loss.h"

namespace synpo {
namespace {
constexpr int kRows = 64;  // samples of a shard
}

template <class T>
SynPo<T>::SynPo(const PolicyShape& shape, Context context)
    : EncodedPolicy<T>(shape),
      env_(context == Context::kTask ? std::optional<EmbeddingTable<T>>()
                                     : EmbeddingTable<T>("embedding.env", shape.envs, shape.embedding,
                                                         shape.normalise_embeddings, this->parameters_)),
      task_("embedding.task", shape.tasks, shape.embedding, shape.normalise_embeddings, this->parameters_),
      coefficient_{{"alpha", coefficient_inputs(), shape.hidden, shape.basis, this->parameters_},
                   {"beta", coefficient_inputs(), shape.hidden, shape.basis, this->parameters_}},
      form_(shape.actions, shape.feature, shape.basis, shape.action_embedding, this->parameters_),
      bias_{this->parameters_.add("policy.bias", {shape.actions}),
            this->parameters_.add("reward.bias", {shape.actions})},
      f_env_(env_ ? Recogniser<T>("f_env", shape.basis, shape.hidden, *env_, this->parameters_)
                  : std::optional<Recogniser<T>>()),
      f_task_("f_task", shape.basis, shape.hidden, task_, this->parameters_) {}

template <class T>
std::vector<typename Policy<T>::OwnGroup> SynPo<T>::own_groups() const {
  return {{ParameterGroup::kRecognisers, {"f_env.", "f_task."}},
          {ParameterGroup::kCoefficients, {"alpha.", "beta."}},
          {ParameterGroup::kHeads, {"theta", "phi", "policy.", "reward."}}};
}

template <class T>
void SynPo<T>::initialise_head(InitStream& stream, double embedding_sd, T* parameters) const {
  if (env_) env_->initialise(stream, embedding_sd, parameters);
  task_.initialise(stream, embedding_sd, parameters);
  for (const Perceptron<T>& coefficient : coefficient_) coefficient.initialise(stream, parameters);
  if (f_env_) f_env_->initialise(stream, parameters);
  f_task_.initialise(stream, parameters);
  form_.initialise(stream, parameters);
}

template <class T>
void SynPo<T>::use_embeddings(const T* parameters) {
  if (env_) env_->use(parameters);
  task_.use(parameters);
}

// alpha and beta of the pairs, and U and V.
template <class T>
void SynPo<T>::compose(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  const int count = int(pairs.size());
  T* input = pair_input_.grow(size_t(count) * coefficient_inputs());
  for (const auto& [env, task] : pairs) {
    if (env_) input = env_->put(env, input);
    input = task_.put(task, input);
  }
  for (int h = 0; h < kHeads; ++h) {
    coefficients_[h] = coefficient_[h].forward(parallel, count, pair_input_.data(), parameters);
    form_.compose(parallel, count, coefficients_[h], parameters, composed_[h].grow(count * form_.matrix_size()));
  }
}

// From dcomposed_: gradients of theta, alpha, beta and the embeddings.
template <class T>
void SynPo<T>::compose_backward(Parallel& parallel, const T* parameters, T* gradient) {
  const int count = int(pairs_.size());
  T* dinput = dpair_input_.grow(size_t(count) * coefficient_inputs());
  T* dcoefficients = dcoefficients_.grow(size_t(count) * shape().basis);
  for (int h = 0; h < kHeads; ++h) {
    form_.compose_backward(parallel, count, coefficients_[h], dcomposed_[h].data(), parameters, dcoefficients,
                           gradient);
    coefficient_[h].backward(parallel, pair_input_.data(), dcoefficients, dinput, h > 0, parameters, gradient);
  }
  const T* from = dinput;
  for (const auto& [env, task] : pairs_) {
    if (env_) from = env_->add_gradient(env, from);
    from = task_.add_gradient(task, from);
  }
}

// Policy and reward losses: logits, dpsi_ and dcomposed_.
template <class T>
Losses SynPo<T>::heads(const HeadStep<T>& step) {
  Parallel& parallel = step.parallel;
  const StepBatch<T>& batch = step.batch;
  const StepOptions& options = step.options;
  const T *parameters = step.parameters, *psi = step.psi;
  T *logits = step.logits, *dpsi = step.dpsi, *gradient = step.gradient;
  const int n = batch.size, d = shape().feature, actions = shape().actions, columns = form_.columns(),
            pairs = int(pairs_.size());
  const size_t matrix = form_.matrix_size();
  for (int h = 0; h < kHeads; ++h) {
    q_[h].grow(size_t(n) * columns);
    dq_[h].grow(size_t(n) * columns);
    dcomposed_[h].grow(pairs * matrix);
  }
  const auto for_samples = [&](auto&& body) {  // body(pair, sample), all heads of a pair's samples by one thread
    parallel.run(pairs, [&](int p, int) {
      for (int j = by_pair_.begin[p]; j < by_pair_.begin[p + 1]; ++j) body(p, size_t(by_pair_.members[j]));
    });
  };
  for_samples([&](int p, size_t i) {
    for (int h = 0; h < kHeads; ++h)
      form_.apply(composed_[h].data() + p * matrix, psi + i * d, q_[h].data() + i * columns);
  });

  const auto for_rows = [&](auto&& body) {
    parallel.run(shard_count(n, kRows), [&](int shard, int) {
      const Range range = shard_range(n, kRows, shard);
      body(range.size(), size_t(range.begin) * columns, size_t(range.begin) * actions);
    });
  };
  for_rows([&](int rows, size_t q_at, size_t at) {
    form_.scores(rows, q_[kPolicy].data() + q_at, parameters, logits + at);
    kernels<T>().add_bias(rows, actions, parameters + bias_[kPolicy], false, logits + at);
  });
  T* dlogits = dlogits_.grow(size_t(n) * actions);
  Losses losses;
  losses.policy = this->score_loss(step, dlogits);
  for_rows([&](int rows, size_t q_at, size_t at) {
    form_.scores_backward(rows, dlogits + at, parameters, dq_[kPolicy].data() + q_at);
  });
  form_.phi_backward(n, q_[kPolicy].data(), dlogits, gradient);
  for (int i = 0; i < n; ++i) {
    for (int a = 0; a < actions; ++a) gradient[bias_[kPolicy] + a] += dlogits[size_t(i) * actions + a];
    const int a = batch.taken[i];
    const T* q = q_[kReward].data() + size_t(i) * columns;
    const T error = form_.score(q, a, parameters) + parameters[bias_[kReward] + a] - batch.reward[i];
    losses.reward += double(error) * error / n;
    const T derror = T(options.weights.reward) * 2 * error / T(n);
    gradient[bias_[kReward] + a] += derror;
    form_.score_backward(q, a, derror, parameters, dq_[kReward].data() + size_t(i) * columns, gradient);
  }

  parallel.run(pairs, [&](int p, int) {
    for (Buffer<T>& dcomposed : dcomposed_) std::fill_n(dcomposed.data() + p * matrix, matrix, T(0));
  });
  for_samples([&](int p, size_t i) {
    for (int h = 0; h < kHeads; ++h)
      form_.apply_backward(composed_[h].data() + p * matrix, psi + i * d, dq_[h].data() + i * columns, dpsi + i * d,
                           dcomposed_[h].data() + p * matrix);
  });
  return losses;
}

// The disentanglement losses. Samples are taken in the order of their labels, so that x is one product an action.
template <class T>
void SynPo<T>::disentangle(const HeadStep<T>& step, Losses& losses) {
  Parallel& parallel = step.parallel;
  const StepBatch<T>& batch = step.batch;
  const T *parameters = step.parameters, *psi = step.psi;
  T *dpsi = step.dpsi, *gradient = step.gradient;
  const LossWeights& weights = step.options.weights;
  const int n = batch.size, d = shape().feature, basis = shape().basis;
  const std::vector<int>& order = by_label_.members;
  T* sorted = psi_sorted_.grow(size_t(n) * d);
  T* dsorted = dpsi_sorted_.grow(size_t(n) * d);
  T* x = x_.grow(size_t(n) * basis);
  T* dx = dx_.grow(size_t(n) * basis);
  parallel.run(shard_count(n, kRows), [&](int shard, int) {
    const Range rows = shard_range(n, kRows, shard);
    for (int j = rows.begin; j < rows.end; ++j) std::copy_n(psi + size_t(order[j]) * d, d, sorted + size_t(j) * d);
    std::fill_n(dx + size_t(rows.begin) * basis, size_t(rows.size()) * basis, T(0));
  });
  form_.use_actions(parallel, by_label_.keys, parameters);
  // Shards within one label each.
  struct Part {
    int group;
    Range rows;
  };
  std::vector<Part> parts;
  for (int g = 0; g < by_label_.count(); ++g)
    for (int begin = by_label_.begin[g]; begin < by_label_.begin[g + 1]; begin += kRows)
      parts.push_back({g, {begin, std::min(begin + kRows, by_label_.begin[g + 1])}});
  parallel.run(int(parts.size()), [&](int shard, int) {
    const auto& [group, rows] = parts[shard];
    gemm(Op::kAsIs, Op::kAsIs, rows.size(), basis, d, sorted + size_t(rows.begin) * d, d,
         form_.action_matrix(group, parameters), basis, x + size_t(rows.begin) * basis, basis);
  });
  truth_.resize(n);
  const auto recognise = [&](Recogniser<T>& f, const int* truth, EmbeddingTable<T>& table, double weight) {
    for (int j = 0; j < n; ++j) truth_[j] = truth[order[j]];
    return f.step(parallel, n, x, truth_.data(), table, weight, parameters, dx, gradient);
  };
  losses.env = f_env_ ? recognise(*f_env_, batch.env, *env_, weights.env) : std::nan("");
  losses.task = recognise(f_task_, batch.task, task_, weights.task);
  parallel.run(int(parts.size()), [&](int shard, int) {
    const auto& [group, rows] = parts[shard];
    gemm(Op::kAsIs, Op::kTransposed, rows.size(), d, basis, dx + size_t(rows.begin) * basis, basis,
         form_.action_matrix(group, parameters), basis, dsorted + size_t(rows.begin) * d, d);
    for (int j = rows.begin; j < rows.end; ++j)
      for (int c = 0; c < d; ++c) dpsi[size_t(order[j]) * d + c] += dsorted[size_t(j) * d + c];
  });
  parallel.run(by_label_.count(), [&](int g, int) {
    const size_t begin = by_label_.begin[g];
    gemm(Op::kTransposed, Op::kAsIs, d, basis, by_label_.size(g), sorted + begin * d, d, dx + begin * basis, basis,
         form_.action_matrix_gradient(g, gradient), basis, true);
  });
  form_.finish_actions(parallel, parameters, gradient);
}

template <class T>
Losses SynPo<T>::head_step(const HeadStep<T>& step) {
  const StepBatch<T>& batch = step.batch;
  const int tasks = shape().tasks;
  by_pair_.sort(batch.size, (env_ ? shape().envs : 1) * tasks,
                [&](int i) { return (env_ ? batch.env[i] * tasks : 0) + batch.task[i]; });
  by_label_.sort(batch.size, shape().actions, [&](int i) { return batch.label[i]; });
  pairs_.clear();
  for (const int key : by_pair_.keys) pairs_.emplace_back(key / tasks, key % tasks);

  use_embeddings(step.parameters);
  compose(step.parallel, step.parameters, pairs_);
  Losses losses = heads(step);
  compose_backward(step.parallel, step.parameters, step.gradient);
  disentangle(step, losses);
  if (env_) env_->backward(step.parameters, step.gradient);
  task_.backward(step.parameters, step.gradient);
  return losses;
}

template <class T>
void SynPo<T>::prepare_head(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  use_embeddings(parameters);
  compose(parallel, parameters, pairs);
  form_.prepare_inference(parameters);
  policy_bias_.assign(parameters + bias_[kPolicy], parameters + bias_[kPolicy] + shape().actions);
}

template <class T>
void SynPo<T>::infer_head(int size, const T* psi, const int* pair, T* logits) const {
  const int d = shape().feature, columns = form_.columns();
  std::vector<T> q(size_t(size) * columns);
  for (int i = 0; i < size; ++i)
    form_.apply(composed_[kPolicy].data() + pair[i] * form_.matrix_size(), psi + size_t(i) * d,
                q.data() + size_t(i) * columns);
  form_.infer(size, q.data(), logits);
  kernels<T>().add_bias(size, shape().actions, policy_bias_.data(), false, logits);
}

template <class T>
std::unique_ptr<EmbeddingLoss> SynPo<T>::embedding_loss(const T* parameters, const std::vector<bool>& new_env,
                                                        const std::vector<bool>& new_task, bool recognisers) const {
  if constexpr (std::is_same_v<T, float>)
    if (env_) return std::make_unique<SynPoEmbeddingLoss>(*this, parameters, new_env, new_task, recognisers);
  return nullptr;
}

template <class T>
size_t SynPo<T>::embedding_loss_step_bytes() const {
  return std::is_same_v<T, float> && env_ ? SynPoEmbeddingLoss::step_bytes(shape()) : 0;
}

template class SynPo<float>;
template class SynPo<double>;

}  // namespace synpo
