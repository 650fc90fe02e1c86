#include "nn/norm.h"

#include <algorithm>
#include <cmath>

#include "nn/lanes.h"

namespace synpo {
namespace {
constexpr size_t kBlock = 64;  // rows summed in T before they are added to the double sums

// sums[i] += lane i of v.
template <class T, class V>
void add_lanes(double* sums, const V& v) {
  T lanes[sizeof(V) / sizeof(T)];
  store(lanes, v);
  for (size_t i = 0; i < sizeof(V) / sizeof(T); ++i) sums[i] += lanes[i];
}

}  // namespace

void ChannelSums::reset(int shards, int channels, int kinds) {
  shards_ = shards;
  channels_ = channels;
  kinds_ = kinds;
  sums_.assign(size_t(shards) * channels * kinds, 0);
}

std::vector<double> ChannelSums::total(int kind) const {
  std::vector<double> sum(channels_, 0);
  for (int shard = 0; shard < shards_; ++shard)
    for (int c = 0; c < channels_; ++c) sum[c] += sums_[(size_t(shard) * kinds_ + kind) * channels_ + c];
  return sum;
}

template <class T>
void BatchNorm<T>::add_rows(int shard, const T* z, size_t rows, const T* running_mean) {
  double* sum = sums_.shard(shard, 0);
  double* squares = sums_.shard(shard, 1);
  for (size_t begin = 0; begin < rows; begin += kBlock) {
    const size_t end = std::min(rows, begin + kBlock);
    for_lanes<T>(channels_, [&](auto tag, int c) {
      using V = decltype(tag);
      const V shift = load<V>(running_mean + c);
      V s{}, q{};
      for (size_t row = begin; row < end; ++row) {
        const V value = load<V>(z + row * channels_ + c) - shift;
        s += value;
        q += value * value;
      }
      add_lanes<T>(sum + c, s);
      add_lanes<T>(squares + c, q);
    });
  }
}

template <class T>
void BatchNorm<T>::finish(size_t rows, const T* gamma, const T* beta, T* running_mean, T* running_variance) {
  const std::vector<double> sum = sums_.total(0), squares = sums_.total(1);
  for (int c = 0; c < channels_; ++c) {
    const double offset = sum[c] / rows;
    const double mean = running_mean[c] + offset;
    const double variance = std::max(0.0, squares[c] / rows - offset * offset);
    const double inverse = 1 / std::sqrt(variance + kNormEpsilon);
    mean_[c] = T(mean);
    inverse_sd_[c] = T(inverse);
    scale_[c] = T(gamma[c] * inverse);
    shift_[c] = T(beta[c] - mean * gamma[c] * inverse);
    const double unbiased = rows > 1 ? variance * rows / (rows - 1) : variance;
    running_mean[c] = T((1 - kNormMomentum) * running_mean[c] + kNormMomentum * mean);
    running_variance[c] = T((1 - kNormMomentum) * running_variance[c] + kNormMomentum * unbiased);
  }
}

template <class T>
void BatchNorm<T>::add_backward_rows(int shard, const T* d, const T* z, size_t rows) {
  double* sum = sums_.shard(shard, 0);
  double* products = sums_.shard(shard, 1);
  for (size_t begin = 0; begin < rows; begin += kBlock) {
    const size_t end = std::min(rows, begin + kBlock);
    for_lanes<T>(channels_, [&](auto tag, int c) {
      using V = decltype(tag);
      const V mean = load<V>(mean_.data() + c);
      V s{}, p{};
      for (size_t row = begin; row < end; ++row) {
        const V value = load<V>(d + row * channels_ + c);
        s += value;
        p += value * (load<V>(z + row * channels_ + c) - mean);
      }
      add_lanes<T>(sum + c, s);
      add_lanes<T>(products + c, p);
    });
  }
}

template <class T>
void BatchNorm<T>::finish_backward(size_t rows, const T* gamma, T* dgamma, T* dbeta) {
  const std::vector<double> sum = sums_.total(0), products = sums_.total(1);
  from_d_.resize(channels_);
  from_z_.resize(channels_);
  constant_.resize(channels_);
  for (int c = 0; c < channels_; ++c) {
    const double inverse = inverse_sd_[c], scale = gamma[c] * inverse;
    const double mean_d = sum[c] / rows, slope = products[c] / rows * inverse * inverse;
    dbeta[c] += T(sum[c]);
    dgamma[c] += T(products[c] * inverse);
    from_d_[c] = T(scale);
    from_z_[c] = T(-scale * slope);
    constant_[c] = T(scale * (slope * mean_[c] - mean_d));
  }
}

template <class T>
void BatchNorm<T>::apply_backward(const T* d, const T* z, T* dz, size_t rows) const {
  for (size_t row = 0; row < rows; ++row)
    for_lanes<T>(channels_, [&](auto tag, int c) {
      using V = decltype(tag);
      const size_t at = row * channels_ + c;
      store(dz + at, V(load<V>(d + at) * load<V>(from_d_.data() + c) +
                       (load<V>(z + at) * load<V>(from_z_.data() + c) + load<V>(constant_.data() + c))));
    });
}

template <class T>
void frozen_norm(int channels, const T* gamma, const T* beta, const T* mean, const T* variance, T* scale, T* shift) {
  for (int c = 0; c < channels; ++c) {
    const double factor = gamma[c] / std::sqrt(double(variance[c]) + kNormEpsilon);
    scale[c] = T(factor);
    shift[c] = T(beta[c] - mean[c] * factor);
  }
}

template <class V>
inline V positive_part(V v) {
  return v > 0 ? v : V{};
}

template <class T>
void norm_relu(const T* z, const T* scale, const T* shift, T* y, size_t rows, int channels) {
  for (size_t row = 0; row < rows; ++row)
    for_lanes<T>(channels, [&](auto tag, int c) {
      using V = decltype(tag);
      const size_t at = row * channels + c;
      store(y + at, positive_part(V(load<V>(z + at) * load<V>(scale + c) + load<V>(shift + c))));
    });
}

template <class T>
void norm_add_relu(const T* z, const T* scale, const T* shift, const T* shortcut, const T* shortcut_scale, const T* shortcut_shift,
                   T* y, size_t rows, int channels) {
  for (size_t row = 0; row < rows; ++row)
    for_lanes<T>(channels, [&](auto tag, int c) {
      using V = decltype(tag);
      const size_t at = row * channels + c;
      V other = load<V>(shortcut + at);
      if (shortcut_scale) other = other * load<V>(shortcut_scale + c) + load<V>(shortcut_shift + c);
      store(y + at, positive_part(V(load<V>(z + at) * load<V>(scale + c) + load<V>(shift + c) + other)));
    });
}

template <class T>
void relu_mask(T* d, const T* y, size_t count) {
  for (size_t i = 0; i < count; ++i) d[i] = y[i] > 0 ? d[i] : T(0);
}

#define SYNPO_INSTANTIATE(T)                                                                                             \
  template class BatchNorm<T>;                                                                                           \
  template void frozen_norm(int, const T*, const T*, const T*, const T*, T*, T*);                                        \
  template void norm_relu(const T*, const T*, const T*, T*, size_t, int);                                                \
  template void norm_add_relu(const T*, const T*, const T*, const T*, const T*, const T*, T*, size_t, int);              \
  template void relu_mask(T*, const T*, size_t);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
