#include "policy/encoder/temporal_net.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "nn/init.h"
#include "nn/layers/dense.h"

namespace synpo {
namespace {

// Both factors of the first convolution's products are larger than a processor's own cache, and one is read anew for
// each shard.
constexpr int kUnit = 128;   // states of a shard
constexpr int kBlock = 256;  // rows of a weight's gradient that are computed together

}  // namespace

template <class T>
TemporalNet<T>::TemporalNet(const ObservationSpec& observation, const TemporalSizes& sizes, int feature,
                            Layout& parameters)
    : view_(observation.view), object_count_(observation.objects), sizes_(sizes),
      feature_(feature), first_{view_, parameters.add("encoder.conv1.weight", {kTaps, view_, sizes.channels}),
                                parameters.add("encoder.conv1.bias", {sizes.channels})},
      second_{sizes.channels, parameters.add("encoder.conv2.weight", {kTaps, sizes.channels, sizes.channels}),
              parameters.add("encoder.conv2.bias", {sizes.channels})},
      objects_(parameters.add("encoder.object", {object_count_, sizes.object_embedding})),
      fc_("encoder.fc", joined_width(), sizes.hidden, feature, parameters), end_(parameters.total()) {}

template <class T>
void TemporalNet<T>::initialise(uint64_t seed, T* parameters, T*) const {
  InitStream stream(seed, 0);
  for (const Convolution* c : {&first_, &second_}) {
    const double bound = 1 / std::sqrt(double(kTaps) * c->in);
    stream.uniform(parameters + c->weight, size_t(kTaps) * c->in * sizes_.channels, bound);
    stream.uniform(parameters + c->bias, size_t(sizes_.channels), bound);
  }
  stream.normal(parameters + objects_, size_t(object_count_) * sizes_.object_embedding, 1);
  fc_.initialise(stream, parameters);
}

template <class T>
const T* TemporalNet<T>::values(int n, const uint8_t* observations, Buffer<T>& own) const {
  const size_t count = n * row();
  if constexpr (std::is_same_v<T, float>) {
    if (reinterpret_cast<uintptr_t>(observations) % alignof(float) == 0)
      return reinterpret_cast<const float*>(observations);
    std::memcpy(own.grow(count), observations, count * sizeof(float));
  } else {
    T* to = own.grow(count);
    for (size_t i = 0; i < count; ++i) {
      float value;
      std::memcpy(&value, observations + i * sizeof value, sizeof value);
      to[i] = value;
    }
  }
  return own.data();
}

template <class T>
void TemporalNet<T>::pack_first(Parallel& parallel, const T* parameters, Packed<T>* taps) const {
  for (int tap = 0; tap < kTaps; ++tap)
    taps[tap].pack(parallel, Op::kAsIs, view_, sizes_.channels, parameters + tap_offset(first_, tap), sizes_.channels);
}

template <class T>
void TemporalNet<T>::convolve(int n, const T* x, const Packed<T>* taps, const T* bias, T* y1) const {
  const int c = sizes_.channels;
  // Output t reads what lies at 2 t - 1, 2 t and 2 t + 1.
  for (int t = 0; t < 2; ++t) {
    const int first = t == 0 ? 1 : 0;
    for (int tap = first; tap < kTaps; ++tap)
      gemm(Op::kAsIs, n, x + size_t(2 * t - 1 + tap) * view_, int(row()), taps[tap], y1 + t * c, 2 * c, tap > first);
  }
  kernels<T>().add_bias(2 * n, c, bias, true, y1);
}

template <class T>
void TemporalNet<T>::put_objects(int n, const T* x, const T* objects, T* joined) const {
  const size_t width = size_t(sizes_.object_embedding);
  for (int i = 0; i < n; ++i)
    std::copy_n(objects + size_t(x[i * row() + views()]) * width, width,
                joined + size_t(i) * joined_width() + sizes_.channels);
}

// The second convolution has one output, which reads all of the first one's through its last two taps: a dense layer.
template <class T>
void TemporalNet<T>::forward(Parallel& parallel, int n, const uint8_t* observations, const T* parameters, T*, T* psi,
                             bool) {
  n_ = n;
  x_ = values(n, observations, own_);
  pack_first(parallel, parameters, taps_);
  const size_t c = size_t(sizes_.channels), width = size_t(joined_width());
  T *y1 = y1_.grow(n * 2 * c), *y2 = y2_.grow(n * c), *joined = joined_.grow(n * width);
  parallel.run(shard_count(n, kUnit), [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    convolve(range.size(), x_ + range.begin * row(), taps_, parameters + first_.bias, y1 + range.begin * 2 * c);
  });
  dense_forward(parallel, n, 2 * sizes_.channels, sizes_.channels, y1, parameters + tap_offset(second_, 1),
                parameters + second_.bias, true, y2);
  for (size_t i = 0; i < size_t(n); ++i) std::copy_n(y2 + i * c, c, joined + i * width);
  put_objects(n, x_, parameters + objects_, joined);
  std::copy_n(fc_.forward(parallel, n, joined, parameters), size_t(n) * feature_, psi);
}

template <class T>
void TemporalNet<T>::backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) {
  const int n = n_, v = view_, c = sizes_.channels, width = joined_width(), embedding = sizes_.object_embedding;
  T *djoined = djoined_.grow(size_t(n) * width), *dy1 = dy1_.grow(size_t(n) * 2 * c), *dy2 = dy2_.grow(size_t(n) * c);
  std::fill(gradient + first_.bias, gradient + end_, T(0));  // the first convolution's weight is in front of it
  fc_.backward(parallel, joined_.data(), dpsi, djoined, false, parameters, gradient);
  for (size_t i = 0; i < size_t(n); ++i) {
    std::copy_n(djoined + i * width, c, dy2 + i * c);
    T* object = gradient + objects_ + size_t(x_[i * row() + views()]) * embedding;
    for (int j = 0; j < embedding; ++j) object[j] += djoined[i * width + c + j];
  }
  dense_backward(parallel, n, 2 * c, c, y1_.data(), parameters + tap_offset(second_, 1), y2_.data(), dy2, dy1, false,
                 gradient + tap_offset(second_, 1), gradient + second_.bias);
  parallel.run(shard_count(n, kUnit), [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    const size_t at = size_t(range.begin) * 2 * c;
    kernels<T>().relu_mask(size_t(range.size()) * 2 * c, dy1 + at, y1_.data() + at);
  });

  // A tap's gradient is the sum over the outputs t of what it read there, transposed, times the gradient of the output.
  for (int t = 0; t < 2; ++t) dy1_packed_[t].pack(parallel, Op::kAsIs, n, c, dy1 + t * c, 2 * c);
  const int blocks = shard_count(v, kBlock);
  parallel.run(kTaps * blocks + 1, [&](int shard, int) {
    if (shard == 0) {
      for (size_t i = 0; i < size_t(n); ++i)
        for (int j = 0; j < c; ++j) gradient[first_.bias + j] += dy1[2 * i * c + j] + dy1[(2 * i + 1) * c + j];
      return;
    }
    const int tap = (shard - 1) / blocks, first = tap == 0 ? 1 : 0;
    const Range range = shard_range(v, kBlock, (shard - 1) % blocks);
    T* to = gradient + tap_offset(first_, tap) + size_t(range.begin) * c;
    for (int t = first; t < 2; ++t)
      gemm(Op::kTransposed, range.size(), x_ + size_t(2 * t - 1 + tap) * v + range.begin, int(row()), dy1_packed_[t],
           to, c, t > first);
  });
}

template <class T>
void TemporalNet<T>::prepare_inference(Parallel& parallel, const T* parameters, const T*) {
  const int c = sizes_.channels;
  pack_first(parallel, parameters, infer_taps_);
  infer_second_.pack(parallel, Op::kAsIs, 2 * c, c, parameters + tap_offset(second_, 1), c);
  fc_.prepare_inference(parameters);
  bias_values_.assign(parameters + first_.bias, parameters + first_.bias + c);
  bias_values_.insert(bias_values_.end(), parameters + second_.bias, parameters + second_.bias + c);
  object_values_.assign(parameters + objects_, parameters + objects_ + size_t(object_count_) * sizes_.object_embedding);
  scratch_.resize(std::max<size_t>(scratch_.size(), parallel.threads()));
}

template <class T>
void TemporalNet<T>::infer(int thread, int n, const uint8_t* observations, T* psi) {
  Scratch& s = scratch_[thread];
  const int c = sizes_.channels;
  const T* x = values(n, observations, s.own);
  T *y1 = s.y1.grow(size_t(n) * 2 * c), *joined = s.joined.grow(size_t(n) * joined_width());
  convolve(n, x, infer_taps_, bias_values_.data(), y1);
  gemm(Op::kAsIs, n, y1, 2 * c, infer_second_, joined, joined_width());
  for (int i = 0; i < n; ++i)
    kernels<T>().add_bias(1, c, bias_values_.data() + c, true, joined + size_t(i) * joined_width());
  put_objects(n, x, object_values_.data(), joined);
  fc_.infer(n, joined, psi, s.hidden);
}

template <class T>
size_t TemporalNet<T>::multiply_adds() const {
  const size_t c = size_t(sizes_.channels);
  return c * (5 * size_t(view_) + 2 * c) + size_t(sizes_.hidden) * (joined_width() + feature_);
}

template class TemporalNet<float>;
template class TemporalNet<double>;

}  // namespace synpo
