#include "torch/learner.h"

#include <ATen/Context.h>
#include <ATen/Parallel.h>
#include <torch/csrc/autograd/autograd.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace synpo {
namespace {

constexpr int kInts = 5;                              // env, task, label, taken, next
constexpr int kGap = 16;                              // values at most between two tensors of a layout
enum Number { kRate, kCorrection, kMove, kNumbers };  // of an update, at the beginning of the floats
constexpr int kFloats = 4;  // of a state: reward; log-probability, advantage and target of PPO

NetworkSizes sizes_of(const TorchConfig& c, const torch::Device& device) {
  NetworkSizes s;
  s.method = c.method;
  s.precision = c.precision;
  s.features = c.features;
  s.side = c.side;
  s.history = c.history;
  s.view = c.view;
  s.object_floats = c.object_floats;
  s.envs = c.envs;
  s.tasks = c.tasks;
  s.actions = c.actions;
  s.feature = c.feature;
  s.embedding = c.embedding;
  s.action_embedding = c.action_embedding;
  s.sf_loss = c.sf_loss;
  s.normalise_input = c.normalise_input;
  s.normalise_embeddings = c.normalise_embeddings;
  s.colours = c.colours;
  if (!c.features) {
    std::vector<float> values;
    for (int frame = 0; frame < c.history; ++frame)
      for (int i = 0; i < 3 * c.colours; ++i) values.push_back(float(c.palette[i]));
    s.palette = torch::tensor(values).view({-1, 3}).to(device);
  }
  return s;
}

// Many threads fill memory faster than one.
void copy_bytes(const uint8_t* from, uint8_t* to, int64_t count) {
  at::parallel_for(0, count, int64_t(1) << 20,
                   [&](int64_t begin, int64_t end) { std::copy(from + begin, from + end, to + begin); });
}

}  // namespace

Learner::Layout::Layout(const TorchLayout& from) {
  for (int i = 0; i < from.count; ++i) {
    const TorchTensor& tensor = from.tensors[i];
    names.push_back(tensor.name);
    shapes.emplace_back(tensor.shape, tensor.shape + tensor.rank);
    tensors.push_back(tensor);
  }
  for (size_t i = 0; i < tensors.size(); ++i) {
    tensors[i].name = names[i].c_str();
    tensors[i].shape = shapes[i].data();
  }
  view = {tensors.data(), int(tensors.size()), from.total};
}

Learner::Learner(const TorchConfig& config)
    : device_(config.device), replay_(device_, config.graphs), sizes_(sizes_of(config, device_)),
      parameters_(config.parameters), statistics_(config.statistics),
      observation_bytes_(config.features ? (int64_t(config.history) * config.view + config.object_floats) * 4
                                         : int64_t(config.side) * config.side * config.history),
      seam_(config.seam), head_(make_head(sizes_)) {
  at::set_num_threads(std::max(1, config.threads));
  const bool coarse = config.precision != TorchPrecision::kFloat32;
  at::globalContext().setAllowTF32CuBLAS(coarse);
  at::globalContext().setAllowTF32CuDNN(coarse);
  at::globalContext().setDeterministicCuDNN(true);
  at::globalContext().setBenchmarkCuDNN(false);
  zeros_ = torch::zeros({kGap}, device_);
}

Learner::Weights Learner::make_weights(bool learned) const {
  Weights weights;
  weights.parameters = torch::zeros({int64_t(parameters_.view.total)}, device_);
  weights.statistics = torch::zeros({int64_t(statistics_.view.total)}, device_);
  weights.w = Views(parameters_.view, weights.parameters, learned);
  weights.running = Views(statistics_.view, weights.statistics, false);
  return weights;
}

void Learner::upload(const float* from, const torch::Tensor& to) const {
  torch::NoGradGuard no_gradient;
  to.copy_(torch::from_blob(const_cast<float*>(from), to.sizes(), torch::kFloat32));
}

void Learner::download(const torch::Tensor& from, float* to) const {
  torch::NoGradGuard no_gradient;
  torch::from_blob(to, from.sizes(), torch::kFloat32).copy_(from);
}

// Graphs know where the memory was: a larger one forgets them.
void Learner::make_room(Exchange& exchange, int64_t n) {
  if (n <= exchange.capacity) return;
  replay_.forget();
  const int64_t floats = kNumbers + n * (kFloats + sizes_.actions + seam_ + sizes_.feature),
                results = kLossKinds + n * (sizes_.actions + sizes_.feature);
  exchange.capacity = n;
  exchange.host_bytes = replay_.host_memory(n * observation_bytes_);
  exchange.host_ints = replay_.host_memory(n * kInts * 4).view(torch::kInt32);
  exchange.host_floats = replay_.host_memory(floats * 4).view(torch::kFloat32);
  exchange.host_results = replay_.host_memory(results * 4).view(torch::kFloat32);
  exchange.bytes = torch::zeros({n * observation_bytes_}, torch::TensorOptions().dtype(torch::kUInt8).device(device_));
  exchange.ints = torch::zeros({n * kInts}, torch::TensorOptions().dtype(torch::kInt32).device(device_));
  exchange.floats = torch::zeros({floats}, device_);
  exchange.results = torch::zeros({results}, device_);
}

// Copies a batch and some numbers beside it to the device. What is null is left as it is.
Inputs Learner::send(Exchange& exchange, const TorchBatch& batch, const double* numbers, int count,
                     const TorchPpoBatch* ppo) {
  const int64_t n = batch.size;
  make_room(exchange, n);
  if (batch.observations)
    copy_bytes(batch.observations, exchange.host_bytes.data_ptr<uint8_t>(), n * observation_bytes_);
  int32_t* ints = exchange.host_ints.data_ptr<int32_t>();
  for (const int* values : {batch.env, batch.task, batch.label, batch.taken, batch.next}) {
    if (values) std::copy_n(values, n, ints);
    ints += n;
  }
  float* floats = exchange.host_floats.data_ptr<float>();
  for (int i = 0; i < count; ++i) floats[i] = float(numbers[i]);
  floats += kNumbers;
  const auto put = [&](const float* values, int64_t width) {
    if (values) std::copy_n(values, n * width, floats);
    floats += n * width;
  };
  put(batch.reward, 1);
  put(ppo ? ppo->log_probability : nullptr, 1);
  put(ppo ? ppo->advantage : nullptr, 1);
  put(ppo ? ppo->target : nullptr, 1);
  put(batch.planner_q, sizes_.actions);
  put(batch.keep, seam_);
  put(batch.psi, sizes_.feature);
  const auto copy = [](const torch::Tensor& from, const torch::Tensor& to, int64_t size) {
    to.narrow(0, 0, size).copy_(from.narrow(0, 0, size), true);
  };
  if (batch.observations) copy(exchange.host_bytes, exchange.bytes, n * observation_bytes_);
  copy(exchange.host_ints, exchange.ints, n * kInts);
  copy(exchange.host_floats, exchange.floats, floats - exchange.host_floats.data_ptr<float>());
  return inputs(exchange, n, batch.psi != nullptr);
}

// The batch as it lies on the device.
Inputs Learner::inputs(const Exchange& exchange, int64_t n, bool psi) const {
  Inputs in;
  in.observations = exchange.bytes.narrow(0, 0, n * observation_bytes_);
  if (sizes_.features) in.observations = in.observations.view(torch::kFloat32);
  in.observations = in.observations.view({n, -1});
  const torch::Tensor ints = exchange.ints.narrow(0, 0, n * kInts).view({kInts, n}).to(torch::kInt64);
  torch::Tensor* whole[kInts] = {&in.env, &in.task, &in.label, &in.taken, &in.next};
  for (int i = 0; i < kInts; ++i) *whole[i] = ints[i];
  int64_t at = kNumbers;
  const auto take = [&](int64_t width) {
    at += n * width;
    return exchange.floats.narrow(0, at - n * width, n * width);
  };
  in.reward = take(1);
  in.log_probability = take(1);
  in.advantage = take(1);
  in.target = take(1);
  in.planner_q = take(sizes_.actions).view({n, -1});
  in.keep = take(seam_).view({n, seam_});
  const torch::Tensor given = take(sizes_.feature).view({n, -1});
  if (psi) in.psi = given;
  return in;
}

// The gradients of all tensors, laid out as the parameters; zero where a tensor has none.
torch::Tensor Learner::flat_gradient(const Layout& layout, const std::vector<torch::Tensor>& gradients) const {
  std::vector<torch::Tensor> parts;
  size_t at = 0;
  for (size_t i = 0; i < gradients.size(); ++i) {
    const TorchTensor& tensor = layout.tensors[i];
    if (tensor.offset > at) parts.push_back(zeros_.narrow(0, 0, int64_t(tensor.offset - at)));
    parts.push_back(gradients[i].defined() ? gradients[i].reshape({-1})
                                           : torch::zeros({int64_t(tensor.size)}, device_));
    at = tensor.offset + tensor.size;
  }
  if (layout.view.total > at) parts.push_back(zeros_.narrow(0, 0, int64_t(layout.view.total - at)));
  return torch::cat(parts);
}

torch::Tensor Learner::total_loss(const Outputs& out, const TorchStepOptions& options) const {
  const double weights[kLossKinds] = {1, options.reward, options.env, options.task};
  torch::Tensor total;
  for (int kind = 0; kind < kLossKinds; ++kind)
    if (out.losses[kind].defined()) {
      const torch::Tensor part = out.losses[kind] * weights[kind];
      total = total.defined() ? total + part : part;
    }
  return total;
}

void Learner::put_results(Exchange& exchange, const Outputs& out) const {
  torch::NoGradGuard no_gradient;
  for (int kind = 0; kind < kLossKinds; ++kind)
    if (out.losses[kind].defined()) exchange.results[kind].copy_(out.losses[kind]);
  exchange.results.narrow(0, kLossKinds, out.logits.numel()).copy_(out.logits.reshape({-1}));
}

// They are there when the work is finished.
void Learner::ask_results(Exchange& exchange, int64_t count) const {
  exchange.host_results.narrow(0, 0, count).copy_(exchange.results.narrow(0, 0, count), true);
}

TorchLosses Learner::fetch_results(Exchange& exchange, int64_t n, float* logits) const {
  replay_.finish();
  const float* results = exchange.host_results.data_ptr<float>();
  std::copy_n(results + kLossKinds, n * sizes_.actions, logits);
  TorchLosses losses;
  for (int kind = 0; kind < kLossKinds; ++kind)
    losses.values[kind] =
        head_->has_loss(LossKind(kind)) ? double(results[kind]) : std::numeric_limits<double>::quiet_NaN();
  return losses;
}

TorchLosses Learner::step(const TorchBatch& batch, const TorchStepOptions& options, const float* parameters,
                          float* statistics, float* gradient, float* logits) {
  const auto entered = replay_.enter();
  if (!step_.parameters.defined()) step_ = make_weights(true);
  upload(parameters, step_.parameters);
  upload(statistics, step_.statistics);
  const Inputs in = send(exchange_, batch, nullptr, 0);
  const torch::Tensor psi =
      in.psi.defined() ? in.psi : encode(sizes_, step_.w, step_.running, in.observations, batch.frozen_statistics);
  const Outputs out = head_->learn(step_.w, psi, in, options.discount, true);
  put_results(exchange_, out);
  ask_results(exchange_, kLossKinds + batch.size * sizes_.actions);
  const TorchLosses losses = fetch_results(exchange_, batch.size, logits);
  const std::vector<torch::Tensor> gradients =
      torch::autograd::grad({total_loss(out, options)}, step_.w.all(), {}, false, false, true);
  torch::NoGradGuard no_gradient;
  download(flat_gradient(parameters_, gradients), gradient);
  if (!batch.frozen_statistics && !batch.psi) download(step_.statistics, statistics);
  replay_.finish();
  return losses;
}

void Learner::take(const TorchArrays& arrays) {
  const auto entered = replay_.enter();
  if (!training_.parameters.defined()) training_ = make_weights(true);
  if (!second_moment_.defined()) second_moment_ = torch::zeros_like(training_.parameters);
  if (!first_moment_.defined()) first_moment_ = torch::zeros_like(training_.parameters);
  replay_.forget();
  upload(arrays.parameters, training_.parameters);
  upload(arrays.statistics, training_.statistics);
  upload(arrays.first_moment, first_moment_);
  upload(arrays.second_moment, second_moment_);
  average_ = average_statistics_ = torch::Tensor();
  if (arrays.average) {
    average_ = torch::zeros_like(training_.parameters);
    average_statistics_ = torch::zeros_like(training_.statistics);
    upload(arrays.average, average_);
    upload(arrays.average_statistics, average_statistics_);
  }
  replay_.finish();
}

// nn/adam.h on the device, with the numbers that change from update to update as tensors.
void Learner::adam(const torch::Tensor& gradient, const TorchAdam& options, const torch::Tensor& numbers) {
  torch::Tensor& parameters = training_.parameters;
  const torch::Tensor g = gradient.add(parameters, options.weight_decay);
  first_moment_.mul_(options.beta1).add_(g, 1 - options.beta1);
  second_moment_.mul_(options.beta2).addcmul_(g, g, 1 - options.beta2);
  const torch::Tensor root = second_moment_.sqrt().mul_(numbers[kCorrection]).add_(options.epsilon);
  parameters.sub_(first_moment_.mul(numbers[kRate]).div_(root));
  if (!average_.defined()) return;
  average_.lerp_(parameters, numbers[kMove]);
  average_statistics_.lerp_(training_.statistics, numbers[kMove]);
}

void Learner::begin_update(const TorchBatch& batch, const TorchStepOptions& options, const TorchAdam& adam_options) {
  const auto entered = replay_.enter();
  double numbers[kNumbers];
  numbers[kRate] = adam_options.learning_rate / (1 - std::pow(adam_options.beta1, double(adam_options.step)));
  numbers[kCorrection] = 1 / std::sqrt(1 - std::pow(adam_options.beta2, double(adam_options.step)));
  numbers[kMove] = 1 - adam_options.keep;
  send(exchange_, batch, numbers, kNumbers);
  const int64_t n = batch.size;
  replay_.run("update " + std::to_string(n), [&] {
    const Inputs in = inputs(exchange_, n, false);
    const torch::Tensor psi = encode(sizes_, training_.w, training_.running, in.observations, batch.frozen_statistics);
    const Outputs out = head_->learn(training_.w, psi, in, options.discount, true);
    const std::vector<torch::Tensor> gradients =
        torch::autograd::grad({total_loss(out, options)}, training_.w.all(), {}, false, false, true);
    torch::NoGradGuard no_gradient;
    adam(flat_gradient(parameters_, gradients), adam_options, exchange_.floats.narrow(0, 0, kNumbers));
    put_results(exchange_, out);
  });
  ask_results(exchange_, kLossKinds + n * sizes_.actions);
  begun_ = n;
}

TorchLosses Learner::end_update(float* logits) {
  const auto entered = replay_.enter();
  return fetch_results(exchange_, begun_, logits);
}

void Learner::give_back(const TorchArrays& arrays) {
  const auto entered = replay_.enter();
  if (!training_.parameters.defined()) return;
  download(training_.parameters, arrays.parameters);
  download(training_.statistics, arrays.statistics);
  download(first_moment_, arrays.first_moment);
  download(second_moment_, arrays.second_moment);
  if (average_.defined()) {
    download(average_, arrays.average);
    download(average_statistics_, arrays.average_statistics);
  }
  replay_.finish();
}

void Learner::prepare_inference(const float* parameters, const float* statistics) {
  const auto entered = replay_.enter();
  if (!inference_.parameters.defined()) inference_ = make_weights(false);
  upload(parameters, inference_.parameters);
  upload(statistics, inference_.statistics);
  replay_.finish();
}

// Always `unit` states, so that the scores of one do not depend on how many are asked for with it.
void Learner::infer(int unit, int size, const uint8_t* observations, const int* env, const int* task, float* logits,
                    float* psi) {
  if (size > unit) throw std::invalid_argument("more states than are scored at once");
  std::lock_guard lock(inference_mutex_);
  const auto entered = replay_.enter();
  torch::NoGradGuard no_gradient;
  Exchange& exchange = inference_exchange_;
  make_room(exchange, unit);
  const auto put = [](auto* to, const auto* from, int64_t count, int64_t room) {
    std::fill_n(std::copy_n(from, count, to), room - count, 0);
  };
  put(exchange.host_bytes.data_ptr<uint8_t>(), observations, size * observation_bytes_, unit * observation_bytes_);
  int32_t* ints = exchange.host_ints.data_ptr<int32_t>();
  put(ints, env, size, unit);
  put(ints + unit, task, size, unit);
  exchange.bytes.copy_(exchange.host_bytes, true);
  exchange.ints.copy_(exchange.host_ints, true);
  const int64_t scores = int64_t(unit) * sizes_.actions, features = int64_t(unit) * sizes_.feature;
  replay_.run("infer " + std::to_string(unit), [&] {
    const Inputs in = inputs(exchange, unit, false);
    const torch::Tensor feature = encode(sizes_, inference_.w, inference_.running, in.observations, true);
    exchange.results.narrow(0, kLossKinds, scores).copy_(head_->scores(inference_.w, feature, in).reshape({-1}));
    exchange.results.narrow(0, kLossKinds + scores, features).copy_(feature.reshape({-1}));
  });
  ask_results(exchange, kLossKinds + scores + (psi ? features : 0));
  replay_.finish();
  const float* results = exchange.host_results.data_ptr<float>() + kLossKinds;
  std::copy_n(results, int64_t(size) * sizes_.actions, logits);
  if (psi) std::copy_n(results + scores, int64_t(size) * sizes_.feature, psi);
}

}  // namespace synpo
