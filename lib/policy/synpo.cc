#include "policy/synpo.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "nn/dense.h"
#include "nn/gemm.h"
#include "nn/loss.h"

namespace synpo {
namespace {
constexpr int kRows = 64;  // samples of a shard
}

template <class T>
SynPo<T>::SynPo(const PolicyShape& shape)
    : shape_(shape), encoder_(shape.channels, shape.feature, shape.normalise_input, this->parameters_, this->statistics_) {
  Layout& layout = this->parameters_;
  env_ = layout.add("embedding.env", {shape.envs, shape.embedding});
  task_ = layout.add("embedding.task", {shape.tasks, shape.embedding});
  alpha_ = add_mlp("alpha", 2 * shape.embedding, shape.basis);
  beta_ = add_mlp("beta", 2 * shape.embedding, shape.basis);
  theta_ = layout.add("theta", {shape.actions, shape.feature, shape.basis});
  policy_bias_ = layout.add("policy.bias", {shape.actions});
  reward_bias_ = layout.add("reward.bias", {shape.actions});
  f_env_ = add_mlp("f_env", shape.basis, shape.embedding);
  f_task_ = add_mlp("f_task", shape.basis, shape.embedding);
}

template <class T>
MlpPlace SynPo<T>::add_mlp(const std::string& name, int in, int out) {
  Layout& layout = this->parameters_;
  return {in, shape_.hidden, out, layout.add(name + ".hidden.weight", {in, shape_.hidden}),
          layout.add(name + ".hidden.bias", {shape_.hidden}), layout.add(name + ".out.weight", {shape_.hidden, out}),
          layout.add(name + ".out.bias", {out})};
}

template <class T>
void SynPo<T>::initialise(const InitOptions& options, T* parameters, T* statistics) const {
  std::fill_n(parameters, this->parameters_.total(), T(0));
  encoder_.initialise(options.seed, parameters, statistics);
  uint64_t tensor = 0;
  const auto fill = [&](size_t at, size_t count, double bound, double sd) {
    Random random(options.seed, Purpose::kInit, 1, tensor++);
    for (size_t i = 0; i < count; ++i) parameters[at + i] = T(sd > 0 ? sd * random.normal() : bound * (2 * random.uniform() - 1));
  };
  const auto xavier = [](int in, int out) { return std::sqrt(6.0 / (in + out)); };
  const PolicyShape& s = shape_;
  fill(env_, size_t(s.envs) * s.embedding, xavier(s.envs, s.embedding), options.embedding_sd);
  fill(task_, size_t(s.tasks) * s.embedding, xavier(s.tasks, s.embedding), options.embedding_sd);
  for (const MlpPlace* mlp : {&alpha_, &beta_, &f_env_, &f_task_}) {
    fill(mlp->hidden_weight, size_t(mlp->in) * mlp->hidden, xavier(mlp->in, mlp->hidden), 0);
    fill(mlp->out_weight, size_t(mlp->hidden) * mlp->out, xavier(mlp->hidden, mlp->out), 0);
  }
  const size_t theta_size = size_t(s.actions) * s.feature * s.basis;
  fill(theta_, theta_size, 1 / std::sqrt(double(theta_size)), 0);
}

// Copies the embeddings, scaled to length sqrt(embedding) where asked.
template <class T>
void SynPo<T>::use_embeddings(const T* parameters) {
  const int width = shape_.embedding;
  const auto use = [&](size_t at, int count, std::vector<T>& used) {
    used.assign(parameters + at, parameters + at + size_t(count) * width);
    if (!shape_.normalise_embeddings) return;
    for (int i = 0; i < count; ++i) {
      double squares = 1e-12;
      for (int c = 0; c < width; ++c) squares += double(used[size_t(i) * width + c]) * used[size_t(i) * width + c];
      const T factor = T(std::sqrt(width / squares));
      for (int c = 0; c < width; ++c) used[size_t(i) * width + c] *= factor;
    }
  };
  use(env_, shape_.envs, env_used_);
  use(task_, shape_.tasks, task_used_);
}

template <class T>
void SynPo<T>::embeddings_backward(const T* parameters, T* gradient) {
  const int width = shape_.embedding;
  const auto back = [&](size_t at, int count, const std::vector<T>& used, const std::vector<T>& dused) {
    for (int i = 0; i < count; ++i) {
      const T* e = parameters + at + size_t(i) * width;
      const T* u = used.data() + size_t(i) * width;
      const T* du = dused.data() + size_t(i) * width;
      T* de = gradient + at + size_t(i) * width;
      double along = 0, squares = 1e-12;
      for (int c = 0; c < width; ++c) {
        along += double(du[c]) * u[c];
        squares += double(e[c]) * e[c];
      }
      const double factor = shape_.normalise_embeddings ? std::sqrt(width / squares) : 1;
      for (int c = 0; c < width; ++c)
        de[c] += T(shape_.normalise_embeddings ? factor * (du[c] - along / width * u[c]) : du[c]);
    }
  };
  back(env_, shape_.envs, env_used_, denv_);
  back(task_, shape_.tasks, task_used_, dtask_);
}

// alpha and beta of the pairs, and U and V.
template <class T>
void SynPo<T>::compose(Parallel& parallel, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  use_embeddings(parameters);
  const int count = int(pairs.size()), width = shape_.embedding, maps = shape_.actions * shape_.feature;
  T* input = pair_input_.grow(size_t(count) * 2 * width);
  for (int i = 0; i < count; ++i) {
    std::copy_n(env_used_.data() + size_t(pairs[i].first) * width, width, input + size_t(i) * 2 * width);
    std::copy_n(task_used_.data() + size_t(pairs[i].second) * width, width, input + (size_t(i) * 2 + 1) * width);
  }
  const MlpPlace* mlps[2] = {&alpha_, &beta_};
  for (int m = 0; m < 2; ++m) {
    const MlpPlace& mlp = *mlps[m];
    T* hidden = hidden_[m].grow(size_t(count) * mlp.hidden);
    T* coefficients = coefficients_[m].grow(size_t(count) * mlp.out);
    T* composed = composed_[m].grow(size_t(count) * maps);
    dense_forward(parallel, count, mlp.in, mlp.hidden, input, parameters + mlp.hidden_weight, parameters + mlp.hidden_bias, true, hidden);
    dense_forward(parallel, count, mlp.hidden, mlp.out, hidden, parameters + mlp.out_weight, parameters + mlp.out_bias, false, coefficients);
    parallel.run(shard_count(count, kRows), [&](int shard, int) {
      const Range range = shard_range(count, kRows, shard);
      gemm(Op::kAsIs, Op::kTransposed, range.size(), maps, shape_.basis, coefficients + size_t(range.begin) * shape_.basis, shape_.basis,
           parameters + theta_, shape_.basis, composed + size_t(range.begin) * maps, maps);
    });
  }
}

// From dcomposed_: gradients of theta, alpha, beta and the embeddings.
template <class T>
void SynPo<T>::compose_backward(Parallel& parallel, const T* parameters, T* gradient) {
  const int count = int(pairs_.size()), width = shape_.embedding, maps = shape_.actions * shape_.feature, basis = shape_.basis;
  T* dinput = dpair_input_.grow(size_t(count) * 2 * width);
  const MlpPlace* mlps[2] = {&alpha_, &beta_};
  for (int m = 0; m < 2; ++m) {
    const MlpPlace& mlp = *mlps[m];
    T* dcoefficients = dcoefficients_[m].grow(size_t(count) * basis);
    T* dhidden = dhidden_[m].grow(size_t(count) * mlp.hidden);
    const T* dcomposed = dcomposed_[m].data();
    parallel.run(shard_count(count, kRows), [&](int shard, int) {
      const Range range = shard_range(count, kRows, shard);
      gemm(Op::kAsIs, Op::kAsIs, range.size(), basis, maps, dcomposed + size_t(range.begin) * maps, maps, parameters + theta_, basis,
           dcoefficients + size_t(range.begin) * basis, basis);
    });
    parallel.run(shard_count(maps, kRows), [&](int shard, int) {
      const Range range = shard_range(maps, kRows, shard);
      gemm(Op::kTransposed, Op::kAsIs, range.size(), basis, count, dcomposed + range.begin, maps, coefficients_[m].data(), basis,
           gradient + theta_ + size_t(range.begin) * basis, basis, true);
    });
    dense_backward<T>(parallel, count, mlp.hidden, mlp.out, hidden_[m].data(), parameters + mlp.out_weight, nullptr, dcoefficients, dhidden,
                      false, gradient + mlp.out_weight, gradient + mlp.out_bias);
    dense_backward<T>(parallel, count, mlp.in, mlp.hidden, pair_input_.data(), parameters + mlp.hidden_weight, hidden_[m].data(), dhidden,
                      dinput, m > 0, gradient + mlp.hidden_weight, gradient + mlp.hidden_bias);
  }
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < width; ++c) {
      denv_[size_t(pairs_[i].first) * width + c] += dinput[size_t(i) * 2 * width + c];
      dtask_[size_t(pairs_[i].second) * width + c] += dinput[(size_t(i) * 2 + 1) * width + c];
    }
}

// Distinct pairs in ascending order, and the samples sorted by pair and by label.
template <class T>
void SynPo<T>::group(const StepBatch<T>& batch) {
  std::vector<int> count(size_t(shape_.envs) * shape_.tasks, 0), number(count.size());
  const auto key = [&](int i) { return batch.env[i] * shape_.tasks + batch.task[i]; };
  for (int i = 0; i < batch.size; ++i) ++count[key(i)];
  pairs_.clear();
  pair_begin_.assign(1, 0);
  for (size_t k = 0; k < count.size(); ++k) {
    if (count[k] == 0) continue;
    number[k] = int(pairs_.size());
    pairs_.emplace_back(int(k) / shape_.tasks, int(k) % shape_.tasks);
    pair_begin_.push_back(pair_begin_.back() + count[k]);
  }
  pair_of_.resize(batch.size);
  by_pair_.resize(batch.size);
  std::vector<int> next(pair_begin_.begin(), pair_begin_.end() - 1);
  for (int i = 0; i < batch.size; ++i) by_pair_[next[pair_of_[i] = number[key(i)]]++] = i;

  label_begin_.assign(shape_.actions + 1, 0);
  for (int i = 0; i < batch.size; ++i) ++label_begin_[batch.label[i] + 1];
  for (int a = 0; a < shape_.actions; ++a) label_begin_[a + 1] += label_begin_[a];
  by_label_.resize(batch.size);
  next.assign(label_begin_.begin(), label_begin_.end() - 1);
  for (int i = 0; i < batch.size; ++i) by_label_[next[batch.label[i]]++] = i;
}

// Policy and reward losses, pair by pair: logits, dpsi_ and dcomposed_.
template <class T>
Losses SynPo<T>::pairs_forward_backward(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters,
                                        T* gradient, T* logits) {
  const int d = shape_.feature, actions = shape_.actions, pairs = int(pairs_.size());
  const T inverse = T(1) / T(batch.size);
  T* du = dcomposed_[0].grow(size_t(pairs) * actions * d);
  T* dv = dcomposed_[1].grow(size_t(pairs) * actions * d);
  std::vector<double> policy_loss(pairs), reward_loss(pairs);
  std::vector<T> dbias(size_t(pairs) * 2 * actions, T(0));
  parallel.run(pairs, [&](int p, int) {
    const size_t at = size_t(p) * actions * d;
    std::fill_n(du + at, actions * d, T(0));
    std::fill_n(dv + at, actions * d, T(0));
    const T* u = composed_[0].data() + at;
    const T* v = composed_[1].data() + at;
    T* dbias_policy = dbias.data() + size_t(p) * 2 * actions;
    T* dbias_reward = dbias_policy + actions;
    std::vector<T> dlogits(actions);
    for (int j = pair_begin_[p]; j < pair_begin_[p + 1]; ++j) {
      const int i = by_pair_[j];
      const T* psi = psi_.data() + size_t(i) * d;
      T* dpsi = dpsi_.data() + size_t(i) * d;
      T* score = logits + size_t(i) * actions;
      for (int a = 0; a < actions; ++a) score[a] = kernels<T>().dot(d, psi, u + a * d) + parameters[policy_bias_ + a];
      policy_loss[p] += cross_entropy(score, actions, batch.label[i], inverse, dlogits.data());
      std::fill_n(dpsi, d, T(0));
      for (int a = 0; a < actions; ++a) {
        dbias_policy[a] += dlogits[a];
        for (int c = 0; c < d; ++c) {
          dpsi[c] += dlogits[a] * u[a * d + c];
          du[at + a * d + c] += dlogits[a] * psi[c];
        }
      }
      const int a = batch.taken[i];
      const T error = kernels<T>().dot(d, psi, v + a * d) + parameters[reward_bias_ + a] - batch.reward[i];
      reward_loss[p] += double(error) * error;
      const T derror = T(weights.reward) * 2 * error * inverse;
      dbias_reward[a] += derror;
      for (int c = 0; c < d; ++c) {
        dpsi[c] += derror * v[a * d + c];
        dv[at + a * d + c] += derror * psi[c];
      }
    }
  });
  Losses losses;
  for (int p = 0; p < pairs; ++p) {
    losses.policy += policy_loss[p] / batch.size;
    losses.reward += reward_loss[p] / batch.size;
    for (int a = 0; a < actions; ++a) {
      gradient[policy_bias_ + a] += dbias[size_t(p) * 2 * actions + a];
      gradient[reward_bias_ + a] += dbias[(size_t(p) * 2 + 1) * actions + a];
    }
  }
  return losses;
}

// One disentanglement loss at x_: the gradient of x is added to dx_.
template <class T>
double SynPo<T>::recognise(Parallel& parallel, const StepBatch<T>& batch, const MlpPlace& mlp, const int* truth, int classes,
                           const T* embeddings, T* dembeddings, double weight, const T* parameters, T* gradient) {
  const int n = batch.size, width = shape_.embedding;
  T* hidden = f_hidden_.grow(size_t(n) * mlp.hidden);
  T* dhidden = df_hidden_.grow(size_t(n) * mlp.hidden);
  T* f = f_.grow(size_t(n) * width);
  T* df = df_.grow(size_t(n) * width);
  T* scores = scores_.grow(size_t(n) * classes);
  T* dscores = dscores_.grow(size_t(n) * classes);
  dense_forward(parallel, n, mlp.in, mlp.hidden, x_.data(), parameters + mlp.hidden_weight, parameters + mlp.hidden_bias, true, hidden);
  dense_forward(parallel, n, mlp.hidden, width, hidden, parameters + mlp.out_weight, parameters + mlp.out_bias, false, f);
  const int shards = shard_count(n, kRows);
  std::vector<double> loss(shards, 0);
  parallel.run(shards, [&](int shard, int) {
    const Range range = shard_range(n, kRows, shard);
    const size_t at = size_t(range.begin) * classes;
    gemm(Op::kAsIs, Op::kTransposed, range.size(), classes, width, f + size_t(range.begin) * width, width, embeddings, width, scores + at,
         classes);
    for (int i = range.begin; i < range.end; ++i)
      loss[shard] += cross_entropy(scores + size_t(i) * classes, classes, truth[by_label_[i]], T(weight / n), dscores + size_t(i) * classes);
    gemm(Op::kAsIs, Op::kAsIs, range.size(), width, classes, dscores + at, classes, embeddings, width, df + size_t(range.begin) * width, width);
  });
  gemm(Op::kTransposed, Op::kAsIs, classes, width, n, dscores, classes, f, width, dembeddings, width, true);
  dense_backward<T>(parallel, n, mlp.hidden, width, hidden, parameters + mlp.out_weight, nullptr, df, dhidden, false,
                    gradient + mlp.out_weight, gradient + mlp.out_bias);
  dense_backward<T>(parallel, n, mlp.in, mlp.hidden, x_.data(), parameters + mlp.hidden_weight, hidden, dhidden, dx_.data(), true,
                    gradient + mlp.hidden_weight, gradient + mlp.hidden_bias);
  double sum = 0;
  for (const double part : loss) sum += part;
  return sum / n;
}

// Both disentanglement losses. Samples are taken in the order of their labels, so that x is one product an action.
template <class T>
void SynPo<T>::disentangle(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* gradient,
                           Losses& losses) {
  const int n = batch.size, d = shape_.feature, basis = shape_.basis, actions = shape_.actions;
  T* sorted = psi_sorted_.grow(size_t(n) * d);
  T* dsorted = dpsi_sorted_.grow(size_t(n) * d);
  T* x = x_.grow(size_t(n) * basis);
  T* dx = dx_.grow(size_t(n) * basis);
  for (int j = 0; j < n; ++j) std::copy_n(psi_.data() + size_t(by_label_[j]) * d, d, sorted + size_t(j) * d);
  std::fill_n(dx, size_t(n) * basis, T(0));
  // Shards within one label each: (label, first sample, end).
  struct Part {
    int label, begin, end;
  };
  std::vector<Part> parts;
  for (int a = 0; a < actions; ++a)
    for (int begin = label_begin_[a]; begin < label_begin_[a + 1]; begin += kRows)
      parts.push_back({a, begin, std::min(begin + kRows, label_begin_[a + 1])});
  const auto theta = [&](int a) { return parameters + theta_ + size_t(a) * d * basis; };
  parallel.run(int(parts.size()), [&](int shard, int) {
    const Part& part = parts[shard];
    gemm(Op::kAsIs, Op::kAsIs, part.end - part.begin, basis, d, sorted + size_t(part.begin) * d, d, theta(part.label), basis,
         x + size_t(part.begin) * basis, basis);
  });
  losses.env = recognise(parallel, batch, f_env_, batch.env, shape_.envs, env_used_.data(), denv_.data(), weights.env, parameters, gradient);
  losses.task = recognise(parallel, batch, f_task_, batch.task, shape_.tasks, task_used_.data(), dtask_.data(), weights.task, parameters, gradient);
  parallel.run(int(parts.size()), [&](int shard, int) {
    const Part& part = parts[shard];
    gemm(Op::kAsIs, Op::kTransposed, part.end - part.begin, d, basis, dx + size_t(part.begin) * basis, basis, theta(part.label), basis,
         dsorted + size_t(part.begin) * d, d);
    for (int j = part.begin; j < part.end; ++j)
      for (int c = 0; c < d; ++c) dpsi_[size_t(by_label_[j]) * d + c] += dsorted[size_t(j) * d + c];
  });
  parallel.run(actions, [&](int a, int) {
    const int begin = label_begin_[a], count = label_begin_[a + 1] - begin;
    if (count > 0)
      gemm(Op::kTransposed, Op::kAsIs, d, basis, count, sorted + size_t(begin) * d, d, dx + size_t(begin) * basis, basis,
           gradient + theta_ + size_t(a) * d * basis, basis, true);
  });
}

template <class T>
Losses SynPo<T>::step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics,
                      T* gradient, T* logits) {
  std::fill(gradient + env_, gradient + this->parameters_.total(), T(0));  // the encoder overwrites its own
  psi_.grow(size_t(batch.size) * shape_.feature);
  dpsi_.grow(size_t(batch.size) * shape_.feature);
  denv_.assign(size_t(shape_.envs) * shape_.embedding, T(0));
  dtask_.assign(size_t(shape_.tasks) * shape_.embedding, T(0));
  group(batch);
  encoder_.forward(parallel, batch.size, batch.pictures, parameters, statistics, psi_.data());
  compose(parallel, parameters, pairs_);
  Losses losses = pairs_forward_backward(parallel, batch, weights, parameters, gradient, logits);
  compose_backward(parallel, parameters, gradient);
  disentangle(parallel, batch, weights, parameters, gradient, losses);
  embeddings_backward(parameters, gradient);
  encoder_.backward(parallel, parameters, dpsi_.data(), gradient);
  losses.total = losses.policy + weights.reward * losses.reward + weights.env * losses.env + weights.task * losses.task;
  return losses;
}

template <class T>
void SynPo<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                                 const std::vector<std::pair<int, int>>& pairs) {
  encoder_.prepare_inference(parallel, parameters, statistics);
  compose(parallel, parameters, pairs);
  inference_bias_.assign(parameters + policy_bias_, parameters + policy_bias_ + shape_.actions);
}

template <class T>
void SynPo<T>::infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) {
  const int d = shape_.feature, actions = shape_.actions;
  std::vector<T> psi(size_t(size) * d);
  encoder_.infer(thread, size, pictures, psi.data());
  for (int i = 0; i < size; ++i)
    for (int a = 0; a < actions; ++a)
      logits[size_t(i) * actions + a] =
          kernels<T>().dot(d, psi.data() + size_t(i) * d, composed_[0].data() + (size_t(pair[i]) * actions + a) * d) + inference_bias_[a];
}

template class SynPo<float>;
template class SynPo<double>;

}  // namespace synpo
