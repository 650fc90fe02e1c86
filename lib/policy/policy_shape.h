// Sizes of a policy, and their names in checkpoints and on the command line.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "policy/temporal_sizes.h"
#include "world/observation.h"

namespace synpo {

// How SF's successor features are learned: temporal differences along the expert, the planner's Q, or cross-entropy of
// Q as scores.
enum class SfLoss { kTemporalDifference, kPlannerQ, kCrossEntropy };

// Sizes of a policy (supplement, Section 4.1). The defaults are the paper's for GridWorld.
struct PolicyShape {
  ObservationSpec observation;                     // of the world
  TemporalSizes views;                             // where observations are features
  std::vector<int> channels = {32, 64, 128, 256};  // of the four stages of Table 2
  int envs = 20, tasks = 20, actions = 5;
  int feature = 128;         // d, of psi(s)
  int basis = 128;           // K
  int embedding = 128;       // of e_env and e_task
  int hidden = 512;          // of alpha, beta, f_env and f_task
  int action_embedding = 0;  // D of phi(a), general form; 0: the direct form
  int head_hidden = 1024;    // hidden units of the baselines' heads
  int seam = 32;             // ModuleNet: what a task's module hands to an environment's
  SfLoss sf_loss = SfLoss::kTemporalDifference;
  bool normalise_input = false;       // per-channel batch normalisation without affine, in place of fixed scaling
  bool normalise_embeddings = false;  // embeddings are scaled to length sqrt(embedding) before use
};

// A size that can be chosen. A new one is a member of PolicyShape and a row of policy_sizes().
struct PolicySize {
  std::string name;  // in checkpoints; an option has '-' for '_'
  int PolicyShape::*member;
  int low, high;      // on the command line
  const char* help;   // what it is
  bool late = false;  // checkpoints made before it have its default
};
const std::vector<PolicySize>& policy_sizes();

// As a checkpoint holds them.
std::map<std::string, int64_t> describe_shape(const PolicyShape& shape);
// Throws kData for sizes that are missing or out of bounds.
PolicyShape parse_shape(const std::map<std::string, int64_t>& sizes);

}  // namespace synpo
