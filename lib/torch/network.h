// The methods and encoders of lib/policy as LibTorch writes them: forward passes and losses, whose gradients autograd
// makes. Names of tensors are those of checkpoints.
#pragma once
#include <torch/types.h>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/torch_api.h"

namespace synpo {

// The tensors of a layout as views of one flat tensor, by name.
class Views {
 public:
  Views() = default;
  Views(const TorchLayout& layout, const torch::Tensor& flat, bool learned);
  const torch::Tensor& operator[](const std::string& name) const { return by_name_.at(name); }
  bool has(const std::string& name) const { return by_name_.count(name) > 0; }
  const std::vector<torch::Tensor>& all() const { return all_; }  // in the layout's order

 private:
  std::map<std::string, torch::Tensor> by_name_;
  std::vector<torch::Tensor> all_;
};

// A batch on the device. Whole numbers are int64, the others float32.
struct Inputs {
  torch::Tensor observations;  // [n, bytes], uint8; pictures, or floats [n, values]
  torch::Tensor psi;           // [n, feature], in place of observations where it is defined
  torch::Tensor env, task, label, taken, next;
  torch::Tensor reward, planner_q, keep;
  torch::Tensor log_probability, advantage, target;  // of PPO
};

enum LossKind { kPolicyLoss, kRewardLoss, kEnvLoss, kTaskLoss, kLossKinds };

struct Outputs {
  torch::Tensor logits;
  std::array<torch::Tensor, kLossKinds> losses;  // undefined where the method has none
};

struct NetworkSizes {
  std::string method;
  TorchPrecision precision;
  bool features;
  int side, history, view, object_floats;
  int envs, tasks, actions, feature, embedding, action_embedding, sf_loss;
  bool normalise_input, normalise_embeddings;
  torch::Tensor palette;  // [history * colours, 3], float32, on the device
  int colours;
};

// What comes after the encoder: a method.
class Head {
 public:
  virtual ~Head() = default;
  virtual torch::Tensor scores(const Views& w, const torch::Tensor& psi, const Inputs& in) const = 0;
  // `imitates`: with imitation's own loss of the scores.
  virtual Outputs learn(const Views& w, const torch::Tensor& psi, const Inputs& in, double discount,
                        bool imitates) const = 0;
  virtual bool has_loss(LossKind kind) const = 0;
};

// Throws std::invalid_argument for a method that it does not know.
std::unique_ptr<Head> make_head(const NetworkSizes& sizes);

// psi [n, feature] of observations. Running statistics move unless they are frozen.
torch::Tensor encode(const NetworkSizes& sizes, const Views& w, const Views& statistics,
                     const torch::Tensor& observations, bool frozen);

}  // namespace synpo
