// PPO's updates, whole on the device: the clipped objective (nn/clipped_objective.h), the value function
// (policy/value_function.h), the auxiliary losses, and RMSProp (nn/rmsprop.h).
#include <torch/csrc/autograd/autograd.h>

#include <cstring>

#include "torch/learner.h"
#include "torch/parts.h"

namespace synpo {
namespace {

enum Result { kPolicy, kEntropy, kKl, kClipFraction, kLargest, kSmallest, kValue, kTotal, kResults };

// -mean min(ratio A, clip(ratio) A) - entropy weight * mean entropy, and what is reported of it.
torch::Tensor clipped_loss(const torch::Tensor& logits, const Inputs& in, const TorchPpoOptions& options,
                           torch::Tensor* results) {
  const torch::Tensor log_p = logits.log_softmax(1), p = log_p.exp(),
                      log_ratio = (log_p * indicator(in.taken, logits.size(1))).sum(1) - in.log_probability,
                      ratio = log_ratio.exp(), clipped = ratio.detach().clamp(1 - options.clip, 1 + options.clip);
  const torch::Tensor limited = (clipped * in.advantage).lt(ratio.detach() * in.advantage);
  // A limited ratio may be infinite, and so would be its derivative, which nothing multiplied with it takes away.
  const torch::Tensor free = torch::where(limited, torch::zeros_like(log_ratio), log_ratio).exp(),
                      policy = -(torch::where(limited, clipped, free) * in.advantage).mean(),
                      entropy = -(p * log_p).sum(1).mean();
  results[kPolicy] = policy;
  results[kEntropy] = entropy;
  results[kKl] = (ratio - 1 - log_ratio).mean();
  results[kClipFraction] = ratio.ne(clipped).to(torch::kFloat32).mean();
  results[kLargest] = ratio.max().clamp_min(1);
  results[kSmallest] = ratio.min().clamp_max(1);
  return policy - options.entropy * entropy;
}

void rmsprop(const torch::Tensor& gradient, const TorchRmsProp& options, const torch::Tensor& rate,
             torch::Tensor& parameters, torch::Tensor& mean_squares) {
  const torch::Tensor g = gradient.add(parameters, options.weight_decay);
  mean_squares.mul_(options.smoothing).addcmul_(g, g, 1 - options.smoothing);
  parameters.sub_((g / mean_squares.sqrt().add_(options.epsilon)).mul_(rate));
}

// Whether what is recorded for one serves the other: the policy's rate alone is read anew at each update.
bool same_but_for_rate(TorchPpoOptions a, const TorchPpoOptions& b) {
  a.policy.learning_rate = b.policy.learning_rate;
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

void Learner::take_ppo(const TorchLayout& layout, const TorchPpoArrays& arrays) {
  const auto entered = replay_.enter();
  if (!training_.parameters.defined()) training_ = make_weights(true);
  if (!second_moment_.defined()) second_moment_ = torch::zeros_like(training_.parameters);
  if (!value_) {
    value_ = std::make_unique<Value>(layout);
    value_->parameters = torch::zeros({int64_t(layout.total)}, device_);
    value_->mean_squares = torch::zeros_like(value_->parameters);
    value_->w = Views(value_->layout.view, value_->parameters, true);
  }
  upload(arrays.parameters, training_.parameters);
  upload(arrays.statistics, training_.statistics);
  upload(arrays.mean_squares, second_moment_);
  upload(arrays.value_parameters, value_->parameters);
  upload(arrays.value_mean_squares, value_->mean_squares);
  replay_.finish();
}

// V of [psi, e_env, e_task], whose embeddings learn nothing from it; one-hot where the method has no such table.
torch::Tensor Learner::values(const torch::Tensor& psi, const Inputs& in) const {
  const auto side = [&](const char* table, const torch::Tensor& numbers, int64_t count) {
    return training_.w.has(table) ? training_.w[table].detach().index_select(0, numbers) : indicator(numbers, count);
  };
  const torch::Tensor x =
      torch::cat({psi, side("embedding.env", in.env, sizes_.envs), side("embedding.task", in.task, sizes_.tasks)}, 1);
  return perceptron(value_->w, "value", x).squeeze(1);
}

TorchPpoLosses Learner::update_ppo(const TorchPpoBatch& batch, const TorchPpoOptions& options) {
  const auto entered = replay_.enter();
  if (!same_but_for_rate(value_->recorded, options)) replay_.forget();
  value_->recorded = options;
  const double rate = options.policy.learning_rate;
  const int64_t n = batch.steps.size;
  send(exchange_, batch.steps, &rate, 1, &batch);
  replay_.run("ppo " + std::to_string(n), [&] {
    const Inputs in = inputs(exchange_, n, false);
    const torch::Tensor psi = encode(sizes_, training_.w, training_.running, in.observations, true);
    const Outputs out = head_->learn(training_.w, psi, in, options.auxiliary.discount, false);
    torch::Tensor results[kResults];
    torch::Tensor total = clipped_loss(out.logits, in, options, results);
    results[kValue] = (values(psi, in) - in.target).square().mean() * 0.5;
    total = total + options.value_weight * results[kValue];
    if (const torch::Tensor auxiliary = total_loss(out, options.auxiliary); auxiliary.defined())
      total = total + auxiliary;
    results[kTotal] = total;
    std::vector<torch::Tensor> all = training_.w.all();
    const size_t own = all.size();
    all.insert(all.end(), value_->w.all().begin(), value_->w.all().end());
    const std::vector<torch::Tensor> gradients = torch::autograd::grad({total}, all, {}, false, false, true);
    torch::NoGradGuard no_gradient;
    torch::Tensor gradient = flat_gradient(parameters_, {gradients.begin(), gradients.begin() + own}),
                  value_gradient = flat_gradient(value_->layout, {gradients.begin() + own, gradients.end()});
    const torch::Tensor length = (gradient.square().sum() + value_gradient.square().sum()).sqrt(),
                        factor = (options.gradient_norm / length).clamp_max(1);
    const torch::Tensor value_rate = torch::full({}, options.value.learning_rate, length.options());
    rmsprop(gradient.mul_(factor), options.policy, exchange_.floats[0], training_.parameters, second_moment_);
    rmsprop(value_gradient.mul_(factor), options.value, value_rate, value_->parameters, value_->mean_squares);
    exchange_.results.narrow(0, 0, kResults)
        .copy_(torch::stack(std::vector<torch::Tensor>(results, results + kResults)));
  });
  ask_results(exchange_, kResults);
  replay_.finish();
  const float* r = exchange_.host_results.data_ptr<float>();
  return {r[kPolicy], r[kEntropy], r[kKl], r[kClipFraction], r[kLargest], r[kSmallest], r[kValue], r[kTotal]};
}

void Learner::give_back_ppo(const TorchPpoArrays& arrays) {
  const auto entered = replay_.enter();
  download(training_.parameters, arrays.parameters);
  download(second_moment_, arrays.mean_squares);
  download(value_->parameters, arrays.value_parameters);
  download(value_->mean_squares, arrays.value_mean_squares);
  replay_.finish();
}

}  // namespace synpo
