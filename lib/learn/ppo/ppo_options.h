// The hyper-parameters of PPO, by name: for the command line and for the checkpoint.
#pragma once
#include <map>
#include <string>

#include "base/cli/options.h"
#include "format/checkpoint.h"
#include "learn/ppo/gae.h"
#include "nn/clipped_objective.h"
#include "nn/rmsprop.h"
#include "policy/losses.h"

namespace synpo {

struct PpoOptions {
  int lanes = 16, rollout = 128;    // worlds side by side, and steps of each before an update
  int epochs = 4, minibatches = 4;  // over a rollout
  int value_warm_up = 20;           // first rollouts, in which the value alone learns
  int value_hidden = 512;
  double value_loss = 1;  // weight of the value's loss
  ClippingOptions clipping;
  double gradient_norm = 0.5;
  GaeOptions gae;
  RmsPropOptions optimiser;
  LossWeights losses;  // the auxiliary ones

  // Adds an option for every one but value_hidden.
  void add_to(Options& options);
  // As a checkpoint has them: names with "ppo." in front.
  std::map<std::string, std::string> describe() const;
  // Throws kData where those of a run's checkpoint are others.
  void check_same(const Checkpoint& checkpoint) const;
  // The auxiliary losses weigh what they did in the run that made the checkpoint, where it says so, but for those whose
  // option was given. Throws kData for values that cannot be read.
  void take_losses(const Checkpoint& from, const Options& given);
};

}  // namespace synpo
