#include "policy/method/modulenet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>

#include "base/random.h"

namespace synpo {

template <class T>
ModuleNet<T>::ModuleNet(const PolicyShape& shape) : EncodedPolicy<T>(shape) {
  for (int task = 0; task < shape.tasks; ++task)
    task_.each.emplace_back("module.task" + std::to_string(task), shape.feature, shape.head_hidden, shape.seam,
                            this->parameters_);
  for (int env = 0; env < shape.envs; ++env)
    env_.each.emplace_back("module.env" + std::to_string(env), shape.seam, shape.head_hidden, shape.actions,
                           this->parameters_);
}

template <class T>
std::vector<typename Policy<T>::OwnGroup> ModuleNet<T>::own_groups() const {
  return {{ParameterGroup::kHeads, {"module."}}};
}

template <class T>
void ModuleNet<T>::initialise_head(InitStream& stream, double, T* parameters) const {
  for (const Modules* modules : {&task_, &env_})
    for (const Perceptron<T>& module : modules->each) module.initialise(stream, parameters);
}

template <class T>
void ModuleNet<T>::Modules::forward(Parallel& parallel, const T* from, const T* parameters, T* to) {
  const int in = each[0].in(), out = each[0].out();
  T* rows = x.grow(groups.members.size() * in);
  for (size_t j = 0; j < groups.members.size(); ++j)
    std::copy_n(from + size_t(groups.members[j]) * in, in, rows + j * in);
  for (int g = 0; g < groups.count(); ++g) {
    const T* y =
        each[groups.keys[g]].forward(parallel, groups.size(g), rows + size_t(groups.begin[g]) * in, parameters);
    for (int j = groups.begin[g]; j < groups.begin[g + 1]; ++j, y += out)
      std::copy_n(y, out, to + size_t(groups.members[j]) * out);
  }
}

template <class T>
void ModuleNet<T>::Modules::backward(Parallel& parallel, const T* dto, T* dfrom, const T* parameters, T* gradient) {
  const int in = each[0].in(), out = each[0].out();
  T* dys = dy.grow(groups.members.size() * out);
  T* dxs = dx.grow(groups.members.size() * in);
  for (size_t j = 0; j < groups.members.size(); ++j)
    std::copy_n(dto + size_t(groups.members[j]) * out, out, dys + j * out);
  for (int g = 0; g < groups.count(); ++g) {
    const size_t begin = groups.begin[g];
    each[groups.keys[g]].backward(parallel, x.data() + begin * in, dys + begin * out, dxs + begin * in, false,
                                  parameters, gradient);
  }
  for (size_t j = 0; j < groups.members.size(); ++j) {
    T* to = dfrom + size_t(groups.members[j]) * in;
    std::transform(dxs + j * in, dxs + (j + 1) * in, to, to, std::plus<T>());
  }
}

template <class T>
std::vector<T> ModuleNet<T>::dropout_factors(const StepBatch<T>& batch, const StepOptions& options) const {
  std::vector<T> factors(size_t(batch.size) * shape().seam, T(1 / (1 - options.dropout)));
  if (options.dropout == 0) return factors;
  Random random(batch.seed, Purpose::kDropout, 0, batch.update);
  for (T& factor : factors)
    if (random.uniform() < options.dropout) factor = 0;
  return factors;
}

template <class T>
Losses ModuleNet<T>::head_step(const HeadStep<T>& step) {
  const auto& [parallel, batch, options, parameters, psi, logits, dpsi, gradient] = step;
  const int n = batch.size;
  const size_t seams = size_t(n) * shape().seam;
  T* seam = seam_.grow(seams);
  T* dseam = dseam_.grow(seams);
  T* dlogits = dlogits_.grow(size_t(n) * shape().actions);
  task_.groups.sort(n, shape().tasks, [&](int i) { return step.batch.task[i]; });
  env_.groups.sort(n, shape().envs, [&](int i) { return step.batch.env[i]; });

  task_.forward(parallel, psi, parameters, seam);
  const std::vector<T> keep = dropout_factors(batch, options);
  for (size_t i = 0; i < seams; ++i) seam[i] *= keep[i];
  env_.forward(parallel, seam, parameters, logits);
  Losses losses;
  losses.reward = losses.env = losses.task = std::nan("");
  losses.policy = this->score_loss(step, dlogits);
  std::fill_n(dseam, seams, T(0));
  env_.backward(parallel, dlogits, dseam, parameters, gradient);
  for (size_t i = 0; i < seams; ++i) dseam[i] *= keep[i];
  task_.backward(parallel, dseam, dpsi, parameters, gradient);
  return losses;
}

template <class T>
void ModuleNet<T>::prepare_head(Parallel&, const T* parameters, const std::vector<std::pair<int, int>>& pairs) {
  for (Modules* modules : {&task_, &env_})
    for (Perceptron<T>& module : modules->each) module.prepare_inference(parameters);
  pairs_ = pairs;
}

template <class T>
void ModuleNet<T>::infer_head(int size, const T* psi, const int* pair, T* logits) const {
  std::vector<T> seam(shape().seam);
  Buffer<T> scratch;
  for (int i = 0; i < size; ++i) {
    const auto [env, task] = pairs_[pair[i]];
    task_.each[task].infer(1, psi + size_t(i) * shape().feature, seam.data(), scratch);
    env_.each[env].infer(1, seam.data(), logits + size_t(i) * shape().actions, scratch);
  }
}

template class ModuleNet<float>;
template class ModuleNet<double>;

}  // namespace synpo
