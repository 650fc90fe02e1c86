// The losses of Algorithm 1 as a function of new embeddings alone, where all else of SynPo stays as it is (adapt.h).
//
// What never changes is computed once for every demonstrated step: x(s, a) of all actions, f_env(x) and f_task(x) at
// the expert's action, and log sum exp of what the old environments, and tasks, score. An update is left with
//   alpha(z) and beta(z) of the pairs drawn,   logits_a = alpha^T x(s, a) + b_a,   r = beta^T x(s, a) + c_a,
// and f(x)^T e of the new e. An episode that is drawn several times is computed once, and weighs so many times as much.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "nn/layers/frozen_perceptron.h"
#include "play/model.h"
#include "policy/head/embedding_table.h"
#include "policy/head/groups.h"

namespace synpo {

class EmbeddingLoss {
 public:
  // Whether there is such a loss for models of this kind.
  static bool fits(const Model& model) { return model.method == "synpo"; }
  // What is kept of a step, in bytes.
  static size_t step_bytes(const PolicyShape& shape);

  // Rows of the embeddings that are marked as new are those to be learned; everything else of the model is taken as it
  // is now.
  EmbeddingLoss(const Model& model, const std::vector<bool>& new_env, const std::vector<bool>& new_task);

  // An episode's steps: psi [size, d], the others [size].
  struct Steps {
    EnvTask pair;
    int size;
    const float* psi;
    const int* label;
    const int* taken;
    const float* reward;
  };
  // Takes episodes in, numbered as they come.
  void add(Parallel& parallel, const std::vector<Steps>& episodes);
  size_t episodes() const { return episodes_.size(); }

  // Means over the steps of the episodes drawn, each as often as it is. In `gradient`, laid out as the model's
  // parameters, both tables of embeddings are overwritten, old rows with zero; the rest is left as it was. Bits do not
  // depend on the number of threads.
  Losses step(Parallel& parallel, const std::vector<size_t>& drawn, const LossWeights& weights, const float* parameters,
              float* gradient);

 private:
  enum Head { kPolicy, kReward, kHeads };
  enum Which { kEnv, kTask, kKinds };
  // Environments, or tasks.
  struct Kind {
    Kind(const Model& model, const std::string& name, const std::vector<bool>& is_new);
    int fresh() const { return int(rows.size()); }
    bool is_old(int row) const { return place[row] == fresh(); }
    size_t at, size;         // of the table among the model's parameters
    std::vector<int> rows;   // the new ones
    std::vector<int> place;  // of a row among them; behind the last for the old ones, which stand together as one class
    EmbeddingTable<float> table;
    FrozenPerceptron<float> f;
    Packed<float> packed;  // the new rows, transposed
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
  // What a shard adds up.
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
  Losses reduce(const std::vector<Part>& parts, const float* parameters, float* gradient);

  PolicyShape shape_;
  Kind kind_[kKinds];
  FrozenPerceptron<float> coefficient_[kHeads];  // alpha, beta
  std::vector<Packed<float>> theta_;             // [A], theta phi(a) [d, K]
  std::vector<float> bias_[kHeads];              // [A]
  std::vector<Episode> episodes_;
  // Of an update: the episodes drawn and how often, sorted by pair; and of every pair [pairs, ...].
  std::vector<size_t> drawn_;
  std::vector<int> times_;
  Groups by_pair_;
  Buffer<float> input_, dinput_, hidden_[kHeads], coefficients_[kHeads], dcoefficients_[kHeads];
};

}  // namespace synpo
