// The hyper-parameters of imitation learning, by name: for the command line, for the checkpoint, and as presets.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/cli/options.h"
#include "learn/steps.h"
#include "nn/adam.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"
#include "world/observation.h"
#include "world/world.h"

namespace synpo {

struct ImitationOptions {
  // An update learns from these.
  double trajectories = 64;  // whole trajectories, where batch_states is 0
  double batch_states = 0;   // single steps from running episodes
  double memory = 20000;     // trajectories kept
  double read = 1;           // trajectories read before an update
  double fill = 1;           // trajectories read before the first update
  double running = 8192, balance = 1, roll_in = 0, roll_noise = 0, roll_limit = kStepLimit;
  bool fresh_starts = false;
  double balance_final = 0;  // what balance moves to, in a straight line, by the run's end; 0: it stays
  // The optimiser.
  bool cosine = false;
  double learning_rate = 0.001, final_rate = 0, warm_up = 0, beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8,
         weight_decay = 0.001;
  double averaging = 0;  // decay of the averaged weights; 0: none
  // The losses.
  double reward_loss = 0.01, env_loss = 0.1, task_loss = 0.001;
  // The network. The world decides what of its shape is its own.
  double embedding_sd = 0;
  PolicyShape network;
  // Of single methods.
  double dropout = 0.2, discount = 0.99;

  StepOptions step() const { return {{reward_loss, env_loss, task_loss}, dropout, discount}; }
  // The part of the schedules that is over at update `update` (from 0) of `total`: nothing during the warm-up.
  double done(int64_t update, int64_t total) const;
  // As they are at that update.
  RunningOptions running_options(int64_t update, int64_t total) const;
  PolicyShape shape(const World& world) const;
  AdamOptions adam() const { return {learning_rate, beta1, beta2, epsilon, weight_decay}; }
  // Learning rate of update `update` (from 0) of `total`: linear warm-up, then constant or half a cosine down to
  // final_rate.
  double rate(int64_t update, int64_t total) const;
};

// "paper" is Algorithm 1 and the supplement to the letter; "fast" is the default. Throws kUsage for another name. Some
// values depend on the method, and on what a world gives to see.
ImitationOptions recipe(const std::string& name, const std::string& method = "synpo", Sight sight = Sight::kPictures);
constexpr char kDefaultRecipe[] = "fast";

// Values given by name, over a recipe.
class RecipeOptions {
 public:
  // Adds --recipe and an option for every hyper-parameter.
  void add_to(Options& options);
  // The recipe with what the command line changed. Throws kUsage for combinations that cannot be.
  ImitationOptions result(const std::string& method, Sight sight = Sight::kPictures) const;
  bool given() const { return !changes_.empty() || recipe_given_ || no_reward_loss_ || no_env_loss_ || no_task_loss_; }
  const std::string& name() const { return recipe_; }
  // Of all options that add_to() adds.
  static std::vector<std::string> option_names();

 private:
  std::string recipe_ = kDefaultRecipe;
  bool recipe_given_ = false, no_reward_loss_ = false, no_env_loss_ = false, no_task_loss_ = false;
  std::map<std::string, double> changes_;
};

std::map<std::string, std::string> describe_options(const ImitationOptions& options);
// Throws kData for a name that is missing or a value that cannot be read.
ImitationOptions parse_options(const std::map<std::string, std::string>& values);

}  // namespace synpo
