#include "nn/layers/norm.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernels.h"

namespace synpo {

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
  kernels<T>().add_moments(rows, channels_, z, running_mean, sums_.shard(shard, 0), sums_.shard(shard, 1));
}

template <class T>
void BatchNorm<T>::freeze(const T* gamma, const T* beta, const T* running_mean, const T* running_variance) {
  frozen_ = true;
  frozen_norm(channels_, gamma, beta, running_mean, running_variance, scale_.data(), shift_.data());
  for (int c = 0; c < channels_; ++c) {
    mean_[c] = running_mean[c];
    inverse_sd_[c] = T(1 / std::sqrt(double(running_variance[c]) + kNormEpsilon));
  }
}

template <class T>
void BatchNorm<T>::finish(size_t rows, const T* gamma, const T* beta, T* running_mean, T* running_variance) {
  frozen_ = false;
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
void BatchNorm<T>::add_backward_rows(int shard, const T* d, const T* z, size_t rows, bool masked) {
  double* sum = sums_.shard(shard, 0);
  double* products = sums_.shard(shard, 1);
  if (masked)
    kernels<T>().add_masked_products(rows, channels_, d, z, mean(), scale(), shift(), sum, products);
  else
    kernels<T>().add_products(rows, channels_, d, z, mean(), sum, products);
}

template <class T>
void BatchNorm<T>::finish_backward(size_t rows, const T* gamma, T* dgamma, T* dbeta) {
  const std::vector<double> sum = sums_.total(0), products = sums_.total(1);
  from_d_.resize(channels_);
  from_z_.resize(channels_);
  constant_.resize(channels_);
  for (int c = 0; c < channels_; ++c) {
    const double inverse = inverse_sd_[c], scale = gamma[c] * inverse;
    const double mean_d = frozen_ ? 0 : sum[c] / rows, slope = frozen_ ? 0 : products[c] / rows * inverse * inverse;
    dbeta[c] = T(sum[c]);
    dgamma[c] = T(products[c] * inverse);
    from_d_[c] = T(scale);
    from_z_[c] = T(-scale * slope);
    constant_[c] = T(scale * (slope * mean_[c] - mean_d));
  }
}

template <class T>
void BatchNorm<T>::apply_backward(const T* d, const T* z, T* dz, size_t rows, bool masked) const {
  kernels<T>().norm_backward(rows, channels_, d, z, from_d_.data(), from_z_.data(), constant_.data(),
                             masked ? scale() : nullptr, masked ? shift() : nullptr, dz);
}

template <class T>
void frozen_norm(int channels, const T* gamma, const T* beta, const T* mean, const T* variance, T* scale, T* shift) {
  for (int c = 0; c < channels; ++c) {
    const double factor = gamma[c] / std::sqrt(double(variance[c]) + kNormEpsilon);
    scale[c] = T(factor);
    shift[c] = T(beta[c] - mean[c] * factor);
  }
}

template class BatchNorm<float>;
template class BatchNorm<double>;
template void frozen_norm(int, const float*, const float*, const float*, const float*, float*, float*);
template void frozen_norm(int, const double*, const double*, const double*, const double*, double*, double*);

}  // namespace synpo
