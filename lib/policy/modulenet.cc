#include "policy/modulenet.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "policy/head_losses.h"

namespace synpo {

template <class T>
ModuleNet<T>::ModuleNet(const PolicyShape& shape)
    : shape_(shape), encoder_(shape.channels, shape.feature, shape.normalise_input, this->parameters_, this->statistics_),
      behind_encoder_(this->parameters_.total()) {
  for (int task = 0; task < shape.tasks; ++task)
    task_.each.emplace_back("module.task" + std::to_string(task), shape.feature, shape.head_hidden, shape.seam, this->parameters_);
  for (int env = 0; env < shape.envs; ++env)
    env_.each.emplace_back("module.env" + std::to_string(env), shape.seam, shape.head_hidden, shape.actions, this->parameters_);
}

template <class T>
void ModuleNet<T>::initialise(const InitOptions& options, T* parameters, T* statistics) const {
  std::fill_n(parameters, this->parameters_.total(), T(0));
  encoder_.initialise(options.seed, parameters, statistics);
  InitStream stream(options.seed, 1);
  for (const Modules* modules : {&task_, &env_})
    for (const Perceptron<T>& module : modules->each) module.initialise(stream, parameters);
}

template <class T>
void ModuleNet<T>::Modules::forward(Parallel& parallel, const T* from, const T* parameters, T* to) {
  const int in = each[0].in(), out = each[0].out();
  T* rows = x.grow(groups.members.size() * in);
  for (size_t j = 0; j < groups.members.size(); ++j) std::copy_n(from + size_t(groups.members[j]) * in, in, rows + j * in);
  for (int g = 0; g < groups.count(); ++g) {
    const T* y = each[groups.keys[g]].forward(parallel, groups.size(g), rows + size_t(groups.begin[g]) * in, parameters);
    for (int j = groups.begin[g]; j < groups.begin[g + 1]; ++j, y += out) std::copy_n(y, out, to + size_t(groups.members[j]) * out);
  }
}

template <class T>
void ModuleNet<T>::Modules::backward(Parallel& parallel, const T* dto, T* dfrom, const T* parameters, T* gradient) {
  const int in = each[0].in(), out = each[0].out();
  T* dys = dy.grow(groups.members.size() * out);
  T* dxs = dx.grow(groups.members.size() * in);
  for (size_t j = 0; j < groups.members.size(); ++j) std::copy_n(dto + size_t(groups.members[j]) * out, out, dys + j * out);
  for (int g = 0; g < groups.count(); ++g) {
    const size_t begin = groups.begin[g];
    each[groups.keys[g]].backward(parallel, x.data() + begin * in, dys + begin * out, dxs + begin * in, false, parameters, gradient);
  }
  for (size_t j = 0; j < groups.members.size(); ++j) std::copy_n(dxs + j * in, in, dfrom + size_t(groups.members[j]) * in);
}

template <class T>
Losses ModuleNet<T>::step(Parallel& parallel, const StepBatch<T>& batch, const LossWeights& weights, const T* parameters, T* statistics,
                          T* gradient, T* logits) {
  const int n = batch.size;
  const size_t seams = size_t(n) * shape_.seam;
  std::fill(gradient + behind_encoder_, gradient + this->parameters_.total(), T(0));
  T* psi = psi_.grow(size_t(n) * shape_.feature);
  T* dpsi = dpsi_.grow(size_t(n) * shape_.feature);
  T* seam = seam_.grow(seams);
  T* dseam = dseam_.grow(seams);
  T* keep = keep_.grow(seams);
  T* dlogits = dlogits_.grow(size_t(n) * shape_.actions);
  task_.groups.sort(n, shape_.tasks, [&](int i) { return batch.task[i]; });
  env_.groups.sort(n, shape_.envs, [&](int i) { return batch.env[i]; });

  encoder_.forward(parallel, n, batch.pictures, parameters, statistics, psi);
  task_.forward(parallel, psi, parameters, seam);
  Random random(batch.seed, Purpose::kDropout, 0, batch.update);
  for (size_t i = 0; i < seams; ++i) {
    keep[i] = weights.dropout > 0 && random.uniform() < weights.dropout ? T(0) : T(1 / (1 - weights.dropout));
    seam[i] *= keep[i];
  }
  env_.forward(parallel, seam, parameters, logits);
  Losses losses;
  losses.reward = losses.env = losses.task = std::nan("");
  losses.policy = policy_loss(parallel, n, shape_.actions, logits, batch.label, dlogits);
  env_.backward(parallel, dlogits, dseam, parameters, gradient);
  for (size_t i = 0; i < seams; ++i) dseam[i] *= keep[i];
  task_.backward(parallel, dseam, dpsi, parameters, gradient);
  encoder_.backward(parallel, parameters, dpsi, gradient);
  losses.add_up(weights);
  return losses;
}

template <class T>
void ModuleNet<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                                     const std::vector<std::pair<int, int>>& pairs) {
  encoder_.prepare_inference(parallel, parameters, statistics);
  for (Modules* modules : {&task_, &env_})
    for (Perceptron<T>& module : modules->each) module.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void ModuleNet<T>::infer(int thread, int size, const uint8_t* pictures, const int* pair, T* logits) {
  std::vector<T> psi(size_t(size) * shape_.feature), seam(shape_.seam);
  Buffer<T> scratch;
  encoder_.infer(thread, size, pictures, psi.data());
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    task_.each[task].infer(1, psi.data() + size_t(i) * shape_.feature, seam.data(), scratch);
    env_.each[env].infer(1, seam.data(), logits + size_t(i) * shape_.actions, scratch);
  }
}

template class ModuleNet<float>;
template class ModuleNet<double>;

}  // namespace synpo
