#include "policy/method/synpo_embedding_loss.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/kernels.h"
#include "nn/loss.h"
#include "policy/head/bilinear_form.h"
#include "world/world.h"

namespace synpo {
namespace {

constexpr int kRows = 32;  // pairs of a shard, where coefficients are made
constexpr int kPairs = 4;  // and where their steps are gone through

// theta phi(a) [d, K] of every action.
std::vector<Packed<float>> action_matrices(const PolicyShape& shape, const BilinearForm<float>& form,
                                           const float* parameters) {
  std::vector<Packed<float>> matrices(shape.actions);
  std::vector<float> matrix(size_t(shape.feature) * shape.basis);
  for (int a = 0; a < shape.actions; ++a) {
    form.make_action_matrix(a, parameters, matrix.data());
    matrices[a].pack(Op::kAsIs, shape.feature, shape.basis, matrix.data(), shape.basis);
  }
  return matrices;
}

std::vector<float> biases(const PolicyShape& shape, const float* values) { return {values, values + shape.actions}; }

double log_sum_exp(const std::vector<float>& scores) {
  if (scores.empty()) return -std::numeric_limits<double>::infinity();
  const float top = *std::ranges::max_element(scores);
  double sum = 0;
  for (const float score : scores) sum += std::exp(double(score) - top);
  return top + std::log(sum);
}

}  // namespace

size_t SynPoEmbeddingLoss::step_bytes(const PolicyShape& shape) {
  return sizeof(float) * (size_t(shape.actions) * shape.basis + kKinds * (shape.embedding + 1) + 1) + 2 * sizeof(int);
}

SynPoEmbeddingLoss::Kind::Kind(const EmbeddingTable<float>& table, const Recogniser<float>& f, const float* parameters,
                               const std::vector<bool>& is_new)
    : table(table), f(f.perceptron().place(), parameters), learned_f(f.perceptron().place()) {
  for (int row = 0; row < int(is_new.size()); ++row)
    if (is_new[row]) rows.push_back(row);
  place.assign(is_new.size(), fresh());
  for (int i = 0; i < fresh(); ++i) place[rows[i]] = i;
}

SynPoEmbeddingLoss::SynPoEmbeddingLoss(const SynPo<float>& policy, const float* parameters,
                                       const std::vector<bool>& new_env, const std::vector<bool>& new_task,
                                       bool recognisers)
    : shape_(policy.shape()),
      learns_recognisers_(recognisers), kind_{{*policy.env_, *policy.f_env_, parameters, new_env},
                                              {policy.task_, policy.f_task_, parameters, new_task}},
      coefficient_{{policy.coefficient_[kPolicy].place(), parameters},
                   {policy.coefficient_[kReward].place(), parameters}},
      theta_(action_matrices(shape_, policy.form_, parameters)), bias_{
                                                                     biases(shape_, parameters + policy.bias_[kPolicy]),
                                                                     biases(shape_,
                                                                            parameters + policy.bias_[kReward])} {
  use_embeddings(parameters);
}

void SynPoEmbeddingLoss::add(Parallel& parallel, const std::vector<Steps>& episodes) {
  const size_t first = episodes_.size();
  episodes_.resize(first + episodes.size());
  parallel.run(int(episodes.size()), [&](int i, int) { take_in(episodes[i], episodes_[first + i]); });
}

void SynPoEmbeddingLoss::take_in(const Steps& steps, Episode& episode) const {
  const int n = steps.size, d = shape_.feature, actions = shape_.actions, basis = shape_.basis;
  episode.key[kEnv] = steps.pair.env;
  episode.key[kTask] = steps.pair.task;
  episode.size = n;
  episode.label.assign(steps.label, steps.label + n);
  episode.taken.assign(steps.taken, steps.taken + n);
  episode.reward.assign(steps.reward, steps.reward + n);
  float* x = episode.x.grow(size_t(n) * actions * basis);
  for (int a = 0; a < actions; ++a) gemm(Op::kAsIs, n, steps.psi, d, theta_[a], x + size_t(a) * basis, actions * basis);
  if (learns_recognisers_) return;
  std::vector<float> at_label(size_t(n) * basis), hidden(size_t(n) * shape_.hidden);
  for (int i = 0; i < n; ++i)
    std::copy_n(x + (size_t(i) * actions + steps.label[i]) * basis, basis, at_label.data() + size_t(i) * basis);
  for (const Which which : {kEnv, kTask}) {
    kind_[which].f.forward(n, at_label.data(), hidden.data(), episode.f[which].grow(size_t(n) * shape_.embedding));
    rate_old(which, episode);
  }
}

void SynPoEmbeddingLoss::rate_old(Which which, Episode& episode) const {
  const Kind& kind = kind_[which];
  const int truth = episode.key[which];
  for (int i = 0; i < episode.size; ++i) {
    std::vector<float> scores;
    float true_score = 0;
    for (int row = 0; row < kind.table.count(); ++row) {
      if (!kind.is_old(row)) continue;
      scores.push_back(kernels<float>().dot(shape_.embedding, episode.f[which].data() + size_t(i) * shape_.embedding,
                                            kind.table.row(row)));
      if (row == truth) true_score = scores.back();
    }
    const double old = log_sum_exp(scores);
    episode.old[which].push_back(float(old));
    if (kind.is_old(truth)) episode.apart[which] += old - true_score;
  }
}

void SynPoEmbeddingLoss::use_embeddings(const float* parameters) {
  const int width = shape_.embedding;
  for (Kind& kind : kind_) {
    kind.table.use(parameters);
    std::vector<float> fresh;
    for (const int row : kind.rows) fresh.insert(fresh.end(), kind.table.row(row), kind.table.row(row) + width);
    kind.packed.pack(Op::kTransposed, width, kind.fresh(), fresh.data(), width);
  }
}

// Returns the number of steps.
size_t SynPoEmbeddingLoss::count_draws(const std::vector<size_t>& drawn) {
  drawn_ = drawn;
  std::ranges::sort(drawn_);
  times_.clear();
  size_t steps = 0, kept = 0;
  for (const size_t episode : drawn_) {
    steps += episodes_[episode].size;
    if (kept > 0 && drawn_[kept - 1] == episode) {
      ++times_.back();
      continue;
    }
    drawn_[kept++] = episode;
    times_.push_back(1);
  }
  drawn_.resize(kept);
  by_pair_.sort(int(kept), shape_.envs * shape_.tasks, [&](int i) {
    const Episode& episode = episodes_[drawn_[i]];
    return episode.key[kEnv] * shape_.tasks + episode.key[kTask];
  });
  return steps;
}

void SynPoEmbeddingLoss::compose(Parallel& parallel) {
  const int pairs = by_pair_.count(), in = kKinds * shape_.embedding, basis = shape_.basis, hidden = shape_.hidden;
  float* input = input_.grow(size_t(pairs) * in);
  for (const int key : by_pair_.keys) {
    input = kind_[kEnv].table.put(key / shape_.tasks, input);
    input = kind_[kTask].table.put(key % shape_.tasks, input);
  }
  for (int h = 0; h < kHeads; ++h) {
    hidden_[h].grow(size_t(pairs) * hidden);
    coefficients_[h].grow(size_t(pairs) * basis);
    dcoefficients_[h].grow(size_t(pairs) * basis);
  }
  const int shards = shard_count(pairs, kRows);
  parallel.run(kHeads * shards, [&](int shard, int) {
    const int h = shard / shards;
    const Range range = shard_range(pairs, kRows, shard % shards);
    const size_t at = range.begin;
    coefficient_[h].forward(range.size(), input_.data() + at * in, hidden_[h].data() + at * hidden,
                            coefficients_[h].data() + at * basis);
    std::fill_n(dcoefficients_[h].data() + at * basis, size_t(range.size()) * basis, 0.0f);
  });
}

void SynPoEmbeddingLoss::compose_backward(Parallel& parallel) {
  const int pairs = by_pair_.count(), in = kKinds * shape_.embedding, basis = shape_.basis, hidden = shape_.hidden;
  float* dinput = dinput_.grow(size_t(pairs) * in);
  parallel.run(shard_count(pairs, kRows), [&](int shard, int) {
    const Range range = shard_range(pairs, kRows, shard);
    const size_t at = range.begin;
    std::vector<float> dhidden(size_t(range.size()) * hidden);
    for (int h = 0; h < kHeads; ++h)
      coefficient_[h].backward(range.size(), hidden_[h].data() + at * hidden, dcoefficients_[h].data() + at * basis,
                               dhidden.data(), dinput + at * in, h > 0);
  });
  const float* from = dinput;
  for (const int key : by_pair_.keys) {
    from = kind_[kEnv].table.add_gradient(key / shape_.tasks, from);
    from = kind_[kTask].table.add_gradient(key % shape_.tasks, from);
  }
}

// Policy and reward, each step with weight `each`.
void SynPoEmbeddingLoss::head_losses(const Episode& episode, float each, double reward_weight, int pair, Part& part) {
  const int actions = shape_.actions, basis = shape_.basis;
  const size_t at = size_t(pair) * basis;
  const float *alpha = coefficients_[kPolicy].data() + at, *beta = coefficients_[kReward].data() + at;
  float *dalpha = dcoefficients_[kPolicy].data() + at, *dbeta = dcoefficients_[kReward].data() + at;
  const Kernels<float>& kernel = kernels<float>();
  std::vector<float> logits(actions), dlogits(actions);
  std::vector<const float*> x(actions);
  for (int i = 0; i < episode.size; ++i) {
    for (int a = 0; a < actions; ++a) {
      x[a] = episode.x.data() + (size_t(i) * actions + a) * basis;
      logits[a] = kernel.dot(basis, alpha, x[a]) + bias_[kPolicy][a];
    }
    part.head[kPolicy] += each * cross_entropy(logits.data(), actions, episode.label[i], each, dlogits.data());
    kernel.combine(actions, x.data(), dlogits.data(), basis, dalpha, true);
    const int taken = episode.taken[i];
    const float error = kernel.dot(basis, beta, x[taken]) + bias_[kReward][taken] - episode.reward[i];
    const float derror = float(reward_weight) * 2 * error * each;
    part.head[kReward] += each * double(error) * error;
    kernel.combine(1, &x[taken], &derror, basis, dbeta, true);
  }
}

// Disentanglement: the old ones are one class more, whose score is the logarithm of their sum.
void SynPoEmbeddingLoss::recognise(Which which, const Episode& episode, float each, double weight, Part& part) const {
  const Kind& kind = kind_[which];
  const int n = episode.size, fresh = kind.fresh(), classes = fresh + 1, width = shape_.embedding;
  part.kind[which] += each * episode.apart[which];
  if (fresh == 0) return;
  const float* f = episode.f[which].data();
  std::vector<float> scores(size_t(n) * classes), dscores(scores.size());
  gemm(Op::kAsIs, n, f, width, kind.packed, scores.data(), classes);
  for (int i = 0; i < n; ++i) {
    float* row = scores.data() + size_t(i) * classes;
    row[fresh] = episode.old[which][i];
    part.kind[which] += each * cross_entropy(row, classes, kind.place[episode.key[which]], float(weight * each),
                                             dscores.data() + size_t(i) * classes);
  }
  gemm(Op::kTransposed, Op::kAsIs, fresh, width, n, dscores.data(), classes, f, width, part.dembedding[which].data(),
       width, true);
}

// Where f_env and f_task are learned: their losses, and the gradients of their own and of the embeddings.
void SynPoEmbeddingLoss::learn_recognisers(Parallel& parallel, size_t steps, const LossWeights& weights,
                                           const float* parameters, float* gradient, Losses& losses) {
  const int actions = shape_.actions, basis = shape_.basis;
  float* x = drawn_x_.grow(steps * basis);
  std::vector<int> truth[kKinds];
  for (size_t i = 0; i < drawn_.size(); ++i) {
    const Episode& episode = episodes_[drawn_[i]];
    for (int time = 0; time < times_[i]; ++time)
      for (int t = 0; t < episode.size; ++t)
        x = std::copy_n(episode.x.data() + (size_t(t) * actions + episode.label[t]) * basis, basis, x);
    for (const Which which : {kEnv, kTask})
      truth[which].insert(truth[which].end(), size_t(times_[i]) * episode.size, episode.key[which]);
  }
  const auto learn = [&](Which which, double weight) {
    Kind& kind = kind_[which];
    const PerceptronPlace at = kind.learned_f.perceptron().place();
    std::fill_n(gradient + at.hidden_weight, size_t(at.in) * at.hidden, 0.0f);
    std::fill_n(gradient + at.hidden_bias, at.hidden, 0.0f);
    std::fill_n(gradient + at.out_weight, size_t(at.hidden) * at.out, 0.0f);
    std::fill_n(gradient + at.out_bias, at.out, 0.0f);
    return kind.learned_f.step(parallel, int(steps), drawn_x_.data(), truth[which].data(), kind.table, weight,
                               parameters, nullptr, gradient);
  };
  losses.env = learn(kEnv, weights.env);
  losses.task = learn(kTask, weights.task);
}

// Adds up the losses, without weights, and the embeddings' gradient.
void SynPoEmbeddingLoss::reduce(const std::vector<Part>& parts, const float* parameters, float* gradient,
                                Losses& losses) {
  for (const Part& part : parts) {
    losses.policy += part.head[kPolicy];
    losses.reward += part.head[kReward];
    losses.env += part.kind[kEnv];
    losses.task += part.kind[kTask];
    for (const Which which : {kEnv, kTask}) {
      const float* from = part.dembedding[which].data();
      for (const int row : kind_[which].rows) from = kind_[which].table.add_gradient(row, from);
    }
  }
  for (Kind& kind : kind_) {
    for (int row = 0; row < kind.table.count(); ++row)
      if (kind.is_old(row)) std::fill_n(kind.table.gradient_row(row), shape_.embedding, 0.0f);
    std::fill_n(gradient + kind.table.offset(), kind.table.size(), 0.0f);
    kind.table.backward(parameters, gradient);
  }
}

Losses SynPoEmbeddingLoss::step(Parallel& parallel, const std::vector<size_t>& drawn, const LossWeights& weights,
                                const float* parameters, float* gradient) {
  const size_t steps = count_draws(drawn);
  use_embeddings(parameters);
  compose(parallel);
  const int pairs = by_pair_.count();
  std::vector<Part> parts(shard_count(pairs, kPairs));
  parallel.run(int(parts.size()), [&](int shard, int) {
    Part& part = parts[shard];
    for (const Which which : {kEnv, kTask})
      part.dembedding[which].assign(size_t(kind_[which].fresh()) * shape_.embedding, 0);
    const Range range = shard_range(pairs, kPairs, shard);
    for (int j = by_pair_.begin[range.begin]; j < by_pair_.begin[range.end]; ++j) {
      const int i = by_pair_.members[j];
      const Episode& episode = episodes_[drawn_[i]];
      const float each = float(times_[i]) / float(steps);
      head_losses(episode, each, weights.reward, by_pair_.group_of[i], part);
      if (!learns_recognisers_) {
        recognise(kEnv, episode, each, weights.env, part);
        recognise(kTask, episode, each, weights.task, part);
      }
    }
  });
  compose_backward(parallel);
  Losses losses;
  if (learns_recognisers_) learn_recognisers(parallel, steps, weights, parameters, gradient, losses);
  reduce(parts, parameters, gradient, losses);
  losses.add_up(weights);
  return losses;
}

}  // namespace synpo
