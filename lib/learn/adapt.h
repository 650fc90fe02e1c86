// Adaptation to new environments and tasks (supplement, Section 5.4, settings 2 and 3): their embeddings are learned
// from a few demonstrations, as in Algorithm 1, while all else stays as it is.
//
// New is what no seen pair of the checkpoint has. What never changes is computed once for every demonstrated step: psi,
// and where embeddings alone, or they and the recognisers, are learned, all that the method's EmbeddingLoss keeps.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "format/checkpoint.h"
#include "nn/adam.h"
#include "nn/buffer.h"
#include "play/episode.h"
#include "play/model.h"
#include "policy/embedding_loss.h"
#include "policy/losses.h"
#include "world/world.h"

namespace synpo {

// These are learned beside the new embeddings.
struct AdaptTargets {
  bool recognisers = false;   // f_env and f_task
  bool basis = false;         // theta, and the biases of policy and reward
  bool coefficients = false;  // alpha and beta
};

struct AdaptOptions {
  int trajectories = 64;  // of an update, drawn from the demonstrations
  AdamOptions adam;       // Algorithm 1's
  LossWeights losses;
  double embedding_sd = 0;
  AdaptTargets targets;
  // For what the method's EmbeddingLoss keeps. Where it is not enough, updates go through the whole head, which takes
  // ten times as long.
  size_t memory_bytes = size_t(2) << 30;
  size_t most_bytes = size_t(8) << 30;  // of what the agent sees in demonstrations, all of which are kept
};

// The same model for a world of more environments: parameters are carried over by environment and task; embeddings of
// what no seen pair has are drawn anew from `seed`. Throws kData where an environment of the checkpoint is another one
// in `world`, kUsage for a method without embeddings of environments and tasks, and for a loss that needs more than
// demonstrations hold (kNeedsMore).
constexpr Cause kNeedsMore{"a loss that needs more than demonstrations hold"};
Model widen(const Model& model, const World& from, const World& world, double embedding_sd, uint64_t seed);

class Adaptation {
 public:
  // `model` as widen() gives it. New are environments and tasks that none of its seen pairs has.
  Adaptation(const World& world, Parallel& parallel, Model model, const AdaptOptions& options, uint64_t seed);

  // Takes a demonstration in. Its pair counts as seen from here on. Throws kData where there is no more room.
  void add(const Episode& episode);
  size_t demonstrations() const { return first_.size() - 1; }
  int new_envs() const;
  int new_tasks() const;

  Losses update();
  const Model& model() const { return model_; }
  // `options`: those that the policy was trained with.
  Checkpoint checkpoint(std::map<std::string, std::string> options) const;

 private:
  struct Span {
    size_t offset, size;  // of parameters
  };
  std::vector<Span> learned() const;
  void compute_features();
  bool has_embedding_loss() const;
  void extend_embedding_loss();
  // Losses of the demonstrations drawn, and gradient_.
  Losses through_head(const std::vector<size_t>& drawn);

  const World& world_;
  Parallel& parallel_;
  Model model_;
  AdaptOptions options_;
  uint64_t seed_;
  std::vector<bool> new_env_, new_task_;
  std::vector<Span> learned_;
  // Demonstrated steps, episode after episode: [steps] each; first_ [episodes + 1].
  std::vector<size_t> first_ = {0};
  std::vector<uint8_t> observations_;
  std::vector<int> env_, task_, label_, taken_;
  std::vector<float> reward_, psi_;
  Buffer<float> gradient_, first_moment_, second_moment_;
  std::vector<float> logits_;
  std::unique_ptr<EmbeddingLoss> embedding_loss_;
  int64_t updates_ = 0;
};

}  // namespace synpo
