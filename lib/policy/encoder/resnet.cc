#include "policy/encoder/resnet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "nn/init.h"
#include "nn/layers/dense.h"
#include "nn/layers/norm.h"

namespace synpo {
namespace {

constexpr int kUnit = 32;                 // samples of a shard
constexpr float kPixelScale = 1.0f / 64;  // "fixed scaling": pixel value to network input

uint8_t value_of(const Rgb& colour, int channel) {
  return channel == 0 ? colour.r : channel == 1 ? colour.g : colour.b;
}

}  // namespace

template <class T>
ResNet<T>::ResNet(const ObservationSpec& observation, const std::vector<int>& channels, int feature,
                  bool normalise_input, Layout& parameters, Layout& statistics)
    : side_(observation.side), feature_(feature), palette_(observation.palette), normalise_input_(normalise_input) {
  static constexpr int strides[4] = {2, 2, 2, 1};
  if (normalise_input_) {
    input_mean_ = statistics.add("encoder.input.mean", {kChannels});
    input_variance_ = statistics.add("encoder.input.variance", {kChannels});
  }
  int side = side_, in = kChannels;
  for (int stage = 0; stage < 4; ++stage)
    for (int b = 0; b < 2; ++b) {
      const std::string name = "encoder.stage" + std::to_string(stage + 1) + ".block" + std::to_string(b + 1);
      blocks_.emplace_back(name, side, in, channels[stage], b == 0 ? strides[stage] : 1, parameters, statistics);
      side = blocks_.back().side_out();
      in = blocks_.back().out();
      largest_ = std::max(largest_, blocks_.back().y_size());
    }
  flat_ = size_t(side) * side * in;
  fc_weight_ = parameters.add("encoder.fc.weight", {int(flat_), feature});
  fc_bias_ = parameters.add("encoder.fc.bias", {feature});
  input_shift_.assign(kChannels, 0);
  input_scale_.assign(kChannels, T(kPixelScale));
}

template <class T>
void ResNet<T>::initialise(uint64_t seed, T* parameters, T* statistics) const {
  InitStream stream(seed, 0);
  for (const ResidualBlock<T>& block : blocks_) block.initialise(stream, parameters, statistics);
  stream.uniform(parameters + fc_weight_, flat_ * feature_, xavier_bound(int(flat_), feature_));
  std::fill_n(parameters + fc_bias_, feature_, T(0));
  if (normalise_input_) {
    std::fill_n(statistics + input_mean_, kChannels, T(0));
    std::fill_n(statistics + input_variance_, kChannels, T(1));
  }
}

template <class T>
void ResNet<T>::expand(int n, const uint8_t* pictures, T* x) const {
  // Value of every (frame, colour), [history, colours, 3].
  const size_t colours = palette_.size();
  std::vector<std::array<T, 3>> values(kHistory * colours);
  for (int f = 0; f < kHistory; ++f)
    for (size_t colour = 0; colour < colours; ++colour)
      for (int i = 0; i < 3; ++i)
        values[f * colours + colour][size_t(i)] =
            (value_of(palette_[colour], i) - input_shift_[3 * f + i]) * input_scale_[3 * f + i];
  for (size_t at = 0; at < n * observation_size(); ++at)
    std::copy_n(values[at % kHistory * colours + pictures[at]].data(), 3, x + 3 * at);
}

template <class T>
void ResNet<T>::prepare_blocks(Parallel& parallel, const T* parameters, bool training) {
  Jobs jobs;
  for (size_t b = blocks_.size(); b-- > 0;)  // the largest first, so that threads end together
    blocks_[b].add_preparations(jobs, parameters, training);
  run_jobs(parallel, jobs);
  work_.use_threads(parallel.threads());
}

template <class T>
void ResNet<T>::freeze_input(const T* statistics) {
  for (int c = 0; c < kChannels; ++c) {
    input_shift_[c] = statistics[input_mean_ + c];
    input_scale_[c] = T(1 / std::sqrt(statistics[input_variance_ + c] + kNormEpsilon));
  }
}

template <class T>
void ResNet<T>::normalise_input(Parallel& parallel, int n, const uint8_t* pictures, T* statistics) {
  const int shards = shard_count(n, kUnit);
  const size_t colours = palette_.size();
  std::vector<std::vector<uint32_t>> counts(shards);  // [history, colours]
  parallel.run(shards, [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    std::vector<uint32_t> count(kHistory * colours, 0);
    for (size_t at = range.begin * observation_size(); at < range.end * observation_size(); ++at)
      ++count[at % kHistory * colours + pictures[at]];
    counts[shard] = std::move(count);
  });
  const double total = double(n) * double(pixels());
  for (int channel = 0; channel < kChannels; ++channel) {
    double sum = 0, squares = 0;
    for (const auto& count : counts)
      for (size_t colour = 0; colour < colours; ++colour) {
        const double value = value_of(palette_[colour], channel % 3), times = count[channel / 3 * colours + colour];
        sum += value * times;
        squares += value * value * times;
      }
    const double mean = sum / total, variance = std::max(0.0, squares / total - mean * mean);
    input_shift_[channel] = T(mean);
    input_scale_[channel] = T(1 / std::sqrt(variance + kNormEpsilon));
    T* running_mean = statistics + input_mean_ + channel;
    T* running_variance = statistics + input_variance_ + channel;
    *running_mean = T((1 - kNormMomentum) * *running_mean + kNormMomentum * mean);
    *running_variance = T((1 - kNormMomentum) * *running_variance + kNormMomentum * variance * total / (total - 1));
  }
}

template <class T>
void ResNet<T>::forward(Parallel& parallel, int n, const uint8_t* pictures, const T* parameters, T* statistics, T* psi,
                        bool frozen) {
  n_ = n;
  prepare_blocks(parallel, parameters, true);
  if (normalise_input_ && frozen) freeze_input(statistics);
  if (normalise_input_ && !frozen) normalise_input(parallel, n, pictures, statistics);
  T* input = input_.grow(n * input_size());
  LazyPictures<T> x = {input, [&](Range samples) {
                         expand(samples.size(), pictures + samples.begin * observation_size(),
                                input + samples.begin * input_size());
                       }};
  for (ResidualBlock<T>& block : blocks_) {
    block.forward(parallel, work_, n, x, parameters, statistics, frozen);
    x = block.output();
  }
  parallel.run(shard_count(n, kUnit), [&](int shard, int) { x.make(shard_range(n, kUnit, shard)); });
  dense_forward(parallel, n, int(flat_), feature_, x.values, parameters + fc_weight_, parameters + fc_bias_, false,
                psi);
}

template <class T>
void ResNet<T>::backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) {
  for (Buffer<T>* buffer : {&work_.d, &work_.dx, &work_.dy1}) buffer->grow(n_ * largest_);
  std::fill_n(gradient + fc_weight_, flat_ * feature_, T(0));
  std::fill_n(gradient + fc_bias_, feature_, T(0));
  dense_backward<T>(parallel, n_, int(flat_), feature_, blocks_.back().output().values, parameters + fc_weight_,
                    nullptr, dpsi, work_.d.data(), false, gradient + fc_weight_, gradient + fc_bias_);
  blocks_.back().begin_backward(parallel, work_);
  for (size_t b = blocks_.size(); b-- > 0;)
    blocks_[b].backward(parallel, work_, b > 0 ? &blocks_[b - 1] : nullptr, parameters, gradient);
  Jobs jobs;
  for (size_t b = blocks_.size(); b-- > 0;) blocks_[b].add_weight_gradients(jobs, gradient);
  run_jobs(parallel, jobs);
}

template <class T>
void ResNet<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) {
  prepare_blocks(parallel, parameters, false);
  for (ResidualBlock<T>& block : blocks_) block.prepare_inference(parameters, statistics);
  if (normalise_input_) freeze_input(statistics);
  fc_packed_.pack(Op::kAsIs, int(flat_), feature_, parameters + fc_weight_, feature_);
  fc_bias_values_.assign(parameters + fc_bias_, parameters + fc_bias_ + feature_);
}

template <class T>
void ResNet<T>::infer(int thread, int n, const uint8_t* pictures, T* psi) {
  auto& scratch = work_.scratch[size_t(thread)];
  const size_t place = n * std::max(input_size(), largest_);
  T* x = scratch.picture.grow(5 * place);
  T* next = x + place;
  T* const spare[3] = {x + 2 * place, x + 3 * place, x + 4 * place};
  expand(n, pictures, x);
  for (const ResidualBlock<T>& block : blocks_) {
    block.infer(n, x, next, spare, scratch.products);
    std::swap(x, next);
  }
  gemm(Op::kAsIs, n, x, int(flat_), fc_packed_, psi, feature_);
  kernels<T>().add_bias(n, feature_, fc_bias_values_.data(), false, psi);
}

template <class T>
size_t ResNet<T>::multiply_adds() const {
  size_t sum = flat_ * feature_;
  for (const ResidualBlock<T>& block : blocks_) sum += block.multiply_adds();
  return sum;
}

template class ResNet<float>;
template class ResNet<double>;

}  // namespace synpo
