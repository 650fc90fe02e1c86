// The losses of Algorithm 1 as a function of new embeddings alone, or of these and f_env and f_task, where all else of
// SynPo stays as it is.
//
// What never changes is computed once for every demonstrated step: x(s, a) of all actions, f_env(x) and f_task(x) at
// the expert's action, and log sum exp of what the old environments, and tasks, score. An update is left with
//   alpha(z) and beta(z) of the pairs drawn,   logits_a = alpha^T x(s, a) + b_a,   r = beta^T x(s, a) + c_a,
// and f(x)^T e of the new e. An episode that is drawn several times is computed once, and weighs so many times as much.
// Where f_env and f_task are learned, they are computed anew from x(s, a) at the expert's action, an episode as often
// as it is drawn.
#pragma once
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/frozen_perceptron.h"
#include "nn/layers/perceptron.h"
#include "policy/embedding_loss.h"
#include "policy/head/embedding_table.h"
#include "policy/head/groups.h"
#include "policy/head/recogniser.h"
#include "policy/losses.h"
#include "policy/method/synpo.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

class SynPoEmbeddingLoss : public EmbeddingLoss {
 public:
  // The bytes that are kept of a step.
  static size_t step_bytes(const PolicyShape& shape);

  // Rows of the embeddings that are marked as new are those to be learned; everything else is taken as it is in
  // `parameters`, but f_env and f_task where `recognisers` asks for them.
  SynPoEmbeddingLoss(const SynPo<float>& policy, const float* parameters, const std::vector<bool>& new_env,
                     const std::vector<bool>& new_task, bool recognisers);

  void add(Parallel& parallel, const std::vector<Steps>& episodes) override;
  size_t episodes() const override { return episodes_.size(); }
  Losses step(Parallel& parallel, const std::vector<size_t>& drawn, const LossWeights& weights, const float* parameters,
              float* gradient) override;

 private:
  using Head = SynPo<float>::Head;
  static constexpr Head kPolicy = Head::kPolicy, kReward = Head::kReward, kHeads = Head::kHeads;
  enum Which { kEnv, kTask, kKinds };
  // Environments, or tasks.
  struct Kind {
    Kind(const EmbeddingTable<float>& table, const Recogniser<float>& f, const float* parameters,
         const std::vector<bool>& is_new);
    int fresh() const { return int(rows.size()); }
    bool is_old(int row) const { return place[row] == fresh(); }
    std::vector<int> rows;   // the new ones
    std::vector<int> place;  // of a row among them; one more than the last for the old ones, which are one class
    EmbeddingTable<float> table;
    FrozenPerceptron<float> f;
    Recogniser<float> learned_f;  // the same, where it is learned
    Packed<float> packed;         // the new rows, transposed
  };
  struct Episode {
    int key[kKinds];  // env and task
    int size;
    std::vector<int> label, taken;
    std::vector<float> reward;
    Buffer<float> x;                 // [size, A, K]
    Buffer<float> f[kKinds];         // [size, E]
    std::vector<float> old[kKinds];  // [size], log sum exp of the old ones' scores
    double apart[kKinds] = {};  // that minus the true one's score, summed over the steps; 0 where the true one is new
  };
  // The sums of a shard.
  struct Part {
    double head[kHeads] = {}, kind[kKinds] = {};
    std::vector<float> dembedding[kKinds];  // [new, E]
  };

  void take_in(const Steps& steps, Episode& episode) const;
  void rate_old(Which which, Episode& episode) const;
  void use_embeddings(const float* parameters);
  size_t count_draws(const std::vector<size_t>& drawn);
  void compose(Parallel& parallel);
  void compose_backward(Parallel& parallel);
  void head_losses(const Episode& episode, float each, double reward_weight, int pair, Part& part);
  void recognise(Which which, const Episode& episode, float each, double weight, Part& part) const;
  void learn_recognisers(Parallel& parallel, size_t steps, const LossWeights& weights, const float* parameters,
                         float* gradient, Losses& losses);
  void reduce(const std::vector<Part>& parts, const float* parameters, float* gradient, Losses& losses);

  PolicyShape shape_;
  bool learns_recognisers_;
  Kind kind_[kKinds];
  FrozenPerceptron<float> coefficient_[kHeads];  // alpha, beta
  std::vector<Packed<float>> theta_;             // [A], theta phi(a) [d, K]
  std::vector<float> bias_[kHeads];              // [A]
  std::vector<Episode> episodes_;
  // Of an update: the episodes drawn and how often, sorted by pair; and of every pair [pairs, ...].
  std::vector<size_t> drawn_;
  std::vector<int> times_;
  Groups by_pair_;
  Buffer<float> drawn_x_;  // [steps, K] at the expert's action, where recognisers are learned
  Buffer<float> input_, dinput_, hidden_[kHeads], coefficients_[kHeads], dcoefficients_[kHeads];
};

}  // namespace synpo
