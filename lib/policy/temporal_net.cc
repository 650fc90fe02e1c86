#include "policy/temporal_net.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace synpo {
namespace {

constexpr int kUnit = 64;   // states of a shard
constexpr int kBlock = 128;  // rows of a weight's gradient that are computed together

}  // namespace

template <class T>
TemporalNet<T>::TemporalNet(const TemporalSizes& sizes, int feature, Layout& parameters)
    : sizes_(sizes), feature_(feature),
      first_{sizes.view, parameters.add("encoder.conv1.weight", {kTaps, sizes.view, sizes.channels}), parameters.add("encoder.conv1.bias", {sizes.channels}), {}},
      second_{sizes.channels, parameters.add("encoder.conv2.weight", {kTaps, sizes.channels, sizes.channels}),
              parameters.add("encoder.conv2.bias", {sizes.channels}), {}},
      objects_(parameters.add("encoder.object", {sizes.objects, sizes.object_embedding})),
      fc_("encoder.fc", joined_width(), sizes.hidden, feature, parameters), end_(parameters.total()) {}

template <class T>
void TemporalNet<T>::initialise(uint64_t seed, T* parameters, T*) const {
  InitStream stream(seed, 0);
  for (const Convolution* c : {&first_, &second_}) {
    const double bound = 1 / std::sqrt(double(kTaps) * c->in);
    stream.uniform(parameters + c->weight, size_t(kTaps) * c->in * sizes_.channels, bound);
    stream.uniform(parameters + c->bias, size_t(sizes_.channels), bound);
  }
  stream.normal(parameters + objects_, size_t(sizes_.objects) * sizes_.object_embedding, 1);
  fc_.initialise(stream, parameters);
}

template <class T>
void TemporalNet<T>::pack(Parallel& parallel, const T* parameters) {
  parallel.run(2 * kTaps, [&](int shard, int) {
    Convolution& c = shard < kTaps ? first_ : second_;
    const int tap = shard % kTaps;
    c.taps[tap].pack(Op::kAsIs, c.in, sizes_.channels, parameters + tap_offset(c, tap), sizes_.channels);
  });
}

template <class T>
void TemporalNet<T>::unpack(int n, const uint8_t* observations, T* views, int* hands) const {
  const size_t values = size_t(kHistory) * sizes_.view;
  std::vector<float> row(values + 1);
  for (int i = 0; i < n; ++i) {
    std::memcpy(row.data(), observations + i * observation_size(), row.size() * sizeof(float));
    std::copy_n(row.data(), values, views + i * values);
    hands[i] = int(row[values]);
  }
}

template <class T>
void TemporalNet<T>::convolve(int n, const T* views, const int* hands, const T* biases, const T* objects, T* y1, T* joined) const {
  const int v = sizes_.view, c = sizes_.channels, ld = kHistory * v, width = joined_width();
  const auto view = [&](int t) { return views + size_t(t) * v; };
  // Output t of a convolution reads what lies at 2 t - 1, 2 t and 2 t + 1.
  gemm(Op::kAsIs, n, view(0), ld, first_.taps[1], y1, 2 * c);
  gemm(Op::kAsIs, n, view(1), ld, first_.taps[2], y1, 2 * c, true);
  gemm(Op::kAsIs, n, view(1), ld, first_.taps[0], y1 + c, 2 * c);
  gemm(Op::kAsIs, n, view(2), ld, first_.taps[1], y1 + c, 2 * c, true);
  gemm(Op::kAsIs, n, view(3), ld, first_.taps[2], y1 + c, 2 * c, true);
  kernels<T>().add_bias(2 * n, c, biases, true, y1);
  gemm(Op::kAsIs, n, y1, 2 * c, second_.taps[1], joined, width);
  gemm(Op::kAsIs, n, y1 + c, 2 * c, second_.taps[2], joined, width, true);
  for (int i = 0; i < n; ++i) {
    T* row = joined + size_t(i) * width;
    kernels<T>().add_bias(1, c, biases + c, true, row);
    std::copy_n(objects + size_t(hands[i]) * sizes_.object_embedding, sizes_.object_embedding, row + c);
  }
}

template <class T>
void TemporalNet<T>::forward(Parallel& parallel, int n, const uint8_t* observations, const T* parameters, T*, T* psi, bool) {
  n_ = n;
  pack(parallel, parameters);
  const size_t row = size_t(kHistory) * sizes_.view, c = size_t(sizes_.channels);
  T *views = views_.grow(n * row), *y1 = y1_.grow(n * 2 * c), *joined = joined_.grow(size_t(n) * joined_width());
  hands_.resize(n);
  bias_values_.resize(2 * c);
  std::copy_n(parameters + first_.bias, c, bias_values_.begin());
  std::copy_n(parameters + second_.bias, c, bias_values_.begin() + c);
  parallel.run(shard_count(n, kUnit), [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    const size_t i = size_t(range.begin);
    unpack(range.size(), observations + i * observation_size(), views + i * row, hands_.data() + i);
    convolve(range.size(), views + i * row, hands_.data() + i, bias_values_.data(), parameters + objects_, y1 + i * 2 * c, joined + i * joined_width());
  });
  std::copy_n(fc_.forward(parallel, n, joined, parameters), size_t(n) * feature_, psi);
}

template <class T>
void TemporalNet<T>::backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) {
  const int n = n_, v = sizes_.view, c = sizes_.channels, width = joined_width(), embedding = sizes_.object_embedding;
  T *djoined = djoined_.grow(size_t(n) * width), *dy1 = dy1_.grow(size_t(n) * 2 * c), *dy2 = dy2_.grow(size_t(n) * c);
  std::fill(gradient + first_.weight, gradient + end_, T(0));
  fc_.backward(parallel, joined_.data(), dpsi, djoined, false, parameters, gradient);

  Packed<T> back[2];  // of the second convolution's taps on y1
  for (int t = 0; t < 2; ++t) back[t].pack(Op::kTransposed, c, c, parameters + tap_offset(second_, t + 1), c);
  parallel.run(shard_count(n, kUnit), [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    for (int i = range.begin; i < range.end; ++i) {
      std::copy_n(djoined + size_t(i) * width, c, dy2 + size_t(i) * c);
      kernels<T>().relu_mask(size_t(c), dy2 + size_t(i) * c, joined_.data() + size_t(i) * width);
    }
    T* d = dy1 + size_t(range.begin) * 2 * c;
    for (int t = 0; t < 2; ++t) gemm(Op::kAsIs, range.size(), dy2 + size_t(range.begin) * c, c, back[t], d + t * c, 2 * c);
    kernels<T>().relu_mask(size_t(range.size()) * 2 * c, d, y1_.data() + size_t(range.begin) * 2 * c);
  });

  // Each tap's gradient is the sum over the outputs t of what it read there, transposed, times the gradient of the output.
  Packed<T> dy1_packed[2], dy2_packed;
  for (int t = 0; t < 2; ++t) dy1_packed[t].pack(Op::kAsIs, n, c, dy1 + t * c, 2 * c);
  dy2_packed.pack(Op::kAsIs, n, c, dy2, c);
  const int blocks = shard_count(v, kBlock), second_blocks = shard_count(c, kBlock);
  parallel.run(kTaps * blocks + 2 * second_blocks + 1, [&](int shard, int) {
    if (shard < kTaps * blocks) {
      const int tap = shard / blocks;
      const Range range = shard_range(v, kBlock, shard % blocks);
      T* to = gradient + tap_offset(first_, tap) + size_t(range.begin) * c;
      for (int t = 0; t < 2; ++t)
        if (const int place = 2 * t - 1 + tap; place >= 0)
          gemm(Op::kTransposed, range.size(), views_.data() + size_t(place) * v + range.begin, kHistory * v, dy1_packed[t], to, c, true);
    } else if (shard < kTaps * blocks + 2 * second_blocks) {
      const int t = (shard - kTaps * blocks) / second_blocks;
      const Range range = shard_range(c, kBlock, (shard - kTaps * blocks) % second_blocks);
      gemm(Op::kTransposed, range.size(), y1_.data() + size_t(t) * c + range.begin, 2 * c, dy2_packed,
           gradient + tap_offset(second_, t + 1) + size_t(range.begin) * c, c);
    } else {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < c; ++j) gradient[first_.bias + j] += dy1[size_t(i) * 2 * c + j] + dy1[(size_t(i) * 2 + 1) * c + j];
        for (int j = 0; j < c; ++j) gradient[second_.bias + j] += dy2[size_t(i) * c + j];
        T* object = gradient + objects_ + size_t(hands_[i]) * embedding;
        for (int j = 0; j < embedding; ++j) object[j] += djoined[size_t(i) * width + c + j];
      }
    }
  });
}

template <class T>
void TemporalNet<T>::prepare_inference(Parallel& parallel, const T* parameters, const T*) {
  pack(parallel, parameters);
  fc_.prepare_inference(parameters);
  bias_values_.assign(parameters + first_.bias, parameters + first_.bias + sizes_.channels);
  bias_values_.insert(bias_values_.end(), parameters + second_.bias, parameters + second_.bias + sizes_.channels);
  object_values_.assign(parameters + objects_, parameters + objects_ + size_t(sizes_.objects) * sizes_.object_embedding);
  scratch_.resize(std::max<size_t>(scratch_.size(), parallel.threads()));
}

template <class T>
void TemporalNet<T>::infer(int thread, int n, const uint8_t* observations, T* psi) {
  Scratch& s = scratch_[thread];
  T* views = s.views.grow(size_t(n) * kHistory * sizes_.view);
  T *y1 = s.y1.grow(size_t(n) * 2 * sizes_.channels), *joined = s.joined.grow(size_t(n) * joined_width());
  s.hands.resize(n);
  unpack(n, observations, views, s.hands.data());
  convolve(n, views, s.hands.data(), bias_values_.data(), object_values_.data(), y1, joined);
  fc_.infer(n, joined, psi, s.hidden);
}

template <class T>
size_t TemporalNet<T>::multiply_adds() const {
  const size_t c = size_t(sizes_.channels);
  return c * (5 * size_t(sizes_.view) + 2 * c) + size_t(sizes_.hidden) * (joined_width() + feature_);
}

template class TemporalNet<float>;
template class TemporalNet<double>;

}  // namespace synpo
