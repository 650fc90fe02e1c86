// Batch normalisation over rows of [rows, channels], in pieces that fuse with what stands beside it: statistics are
// gathered while a convolution's output is still in the cache; scaling, addition and ReLU are one pass
// (kernel/kernels.h).
#pragma once
#include <cstddef>
#include <vector>

namespace synpo {

constexpr double kNormEpsilon = 1e-5, kNormMomentum = 0.1;

// Sums over rows, per channel and shard, in double; reduced in the order of the shards.
class ChannelSums {
 public:
  void reset(int shards, int channels, int kinds);
  double* shard(int shard, int kind) { return sums_.data() + (size_t(shard) * kinds_ + kind) * channels_; }
  // Adds up the shards of one kind.
  std::vector<double> total(int kind) const;

 private:
  int shards_ = 0, channels_ = 0, kinds_ = 0;
  std::vector<double> sums_;
};

template <class T>
class BatchNorm {
 public:
  explicit BatchNorm(int channels = 0)
      : channels_(channels), scale_(channels), shift_(channels), mean_(channels), inverse_sd_(channels) {}
  int channels() const { return channels_; }

  // Training, forward: every shard adds its rows (the running mean is subtracted first, so that squares don't cancel)
  // ...
  void begin(int shards) { sums_.reset(shards, channels_, 2); }
  void add_rows(int shard, const T* z, size_t rows, const T* running_mean);
  // ... then the batch's statistics are made, and the running ones moved (unbiased variance, as PyTorch does it).
  void finish(size_t rows, const T* gamma, const T* beta, T* running_mean, T* running_variance);

  // Instead of begin() to finish(): the running statistics are taken as they are, and no gradient goes through them.
  void freeze(const T* gamma, const T* beta, const T* running_mean, const T* running_variance);

  // y = z * scale() + shift() normalises, with gamma and beta.
  const T* scale() const { return scale_.data(); }
  const T* shift() const { return shift_.data(); }
  const T* mean() const { return mean_.data(); }
  const T* inverse_sd() const { return inverse_sd_.data(); }

  // Training, backward: every shard adds sum(d) and sum(d * (z - mean)) over its rows; with `masked`, d is the gradient
  // after a ReLU that stands right after the normalisation, here as in apply_backward() ...
  void begin_backward(int shards) { sums_.reset(shards, channels_, 2); }
  void add_backward_rows(int shard, const T* d, const T* z, size_t rows, bool masked);
  // ... then dgamma, dbeta = their gradients, and apply_backward gives dz (which may be d itself).
  void finish_backward(size_t rows, const T* gamma, T* dgamma, T* dbeta);
  void apply_backward(const T* d, const T* z, T* dz, size_t rows, bool masked) const;

 private:
  int channels_;
  bool frozen_ = false;
  std::vector<T> scale_, shift_, mean_, inverse_sd_;
  std::vector<T> from_d_, from_z_, constant_;  // dz = d * from_d + z * from_z + constant
  ChannelSums sums_;
};

// Scale and shift of a normalisation by running statistics.
template <class T>
void frozen_norm(int channels, const T* gamma, const T* beta, const T* mean, const T* variance, T* scale, T* shift);

}  // namespace synpo
