// The training pass of the residual network: forward with the batch's statistics, and backward.
#include <algorithm>
#include <array>
#include <cmath>

#include "nn/layers/dense.h"
#include "policy/encoder/resnet.h"

namespace synpo {
namespace {
constexpr int kUnit = 32;  // samples of a shard where no convolution asks for another number
}  // namespace

template <class T>
void ResNet<T>::normalise_input(Parallel& parallel, int n, const uint8_t* pictures, T* statistics) {
  const int shards = shard_count(n, kUnit);
  std::vector<std::array<std::array<uint32_t, kGridColours>, kHistory>> counts(shards);
  parallel.run(shards, [&](int shard, int) {
    const Range range = shard_range(n, kUnit, shard);
    auto& count = counts[shard];
    for (auto& frame : count) frame.fill(0);
    for (size_t at = size_t(range.begin) * kGridCells * kHistory; at < size_t(range.end) * kGridCells * kHistory; ++at)
      ++count[at % kHistory][pictures[at]];
  });
  const double total = double(n) * kGridCells;
  for (int channel = 0; channel < kViewChannels; ++channel) {
    double sum = 0, squares = 0;
    for (const auto& count : counts)
      for (int colour = 0; colour < kGridColours; ++colour) {
        const uint8_t rgb[3] = {kPalette[colour].r, kPalette[colour].g, kPalette[colour].b};
        const double value = rgb[channel % 3];
        sum += value * count[channel / 3][colour];
        squares += value * value * count[channel / 3][colour];
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
void ResNet<T>::finish_block(Block& block, Range samples) {
  const Conv<T>& conv = block.convs[1];
  const size_t at = samples.begin * conv.y_size();
  const size_t rows = size_t(samples.size()) * conv.side_out() * conv.side_out();
  const BatchNorm<T>& norm = block.norms[1];
  const bool own = block.has_shortcut();
  const T* shortcut = own ? block.z[2].data() : block_input(&block - blocks_.data());
  kernels<T>().norm_add_relu(rows, conv.out(), block.z[1].data() + at, norm.scale(), norm.shift(), shortcut + at,
                             own ? block.norms[2].scale() : nullptr, own ? block.norms[2].shift() : nullptr,
                             block.y.data() + at);
}

template <class T>
void ResNet<T>::forward(Parallel& parallel, int n, const uint8_t* pictures, const T* parameters, T* statistics, T* psi,
                        bool frozen) {
  n_ = n;
  prepare_convs(parallel, parameters, true);
  if (normalise_input_ && frozen) freeze_input(statistics);
  if (normalise_input_ && !frozen) normalise_input(parallel, n, pictures, statistics);
  input_.grow(n * kInputSize);
  for (size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    for (size_t i = 0; i < block.convs.size(); ++i) block.z[i].grow(n * block.convs[i].y_size());
    block.y.grow(n * block.convs[0].y_size());
    const T* x = block_input(b);
    const int unit = block.convs[0].unit(), shards = shard_count(n, unit);
    const int pixels = block.convs[0].side_out() * block.convs[0].side_out();
    const auto convolve = [&](int i, const T* from, Range range, int shard, int thread) {
      const Conv<T>& conv = block.convs[i];
      T* z = block.z[i].data() + range.begin * conv.y_size();
      conv.forward(range.size(), from, z, scratch_[thread].products);
      if (!frozen) block.norms[i].add_rows(shard, z, size_t(range.size()) * pixels, statistics + block.places[i].mean);
    };
    const auto finish_norm = [&](int i) {
      const NormPlace& place = block.places[i];
      if (frozen)
        return block.norms[i].freeze(parameters + place.scale, parameters + place.shift, statistics + place.mean,
                                     statistics + place.variance);
      block.norms[i].finish(size_t(n) * pixels, parameters + place.scale, parameters + place.shift,
                            statistics + place.mean, statistics + place.variance);
    };
    for (size_t i = 0; i < block.convs.size(); ++i) block.norms[i].begin(shards);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(n, unit, shard);
      if (b == 0)
        expand(range.size(), pictures + size_t(range.begin) * kGridCells * kHistory, input_shift_.data(),
               input_scale_.data(), input_.data() + range.begin * kInputSize);
      else
        finish_block(blocks_[b - 1], range);
      convolve(0, x + range.begin * block.convs[0].x_size(), range, shard, thread);
      if (block.has_shortcut()) convolve(2, x + range.begin * block.convs[2].x_size(), range, shard, thread);
    });
    finish_norm(0);
    if (block.has_shortcut()) finish_norm(2);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(n, unit, shard);
      const size_t size = block.convs[0].y_size();
      T* y1 = scratch_[thread].picture.grow(range.size() * size);
      kernels<T>().norm_relu(size_t(range.size()) * pixels, block.convs[0].out(),
                             block.z[0].data() + range.begin * size, block.norms[0].scale(), block.norms[0].shift(),
                             y1);
      convolve(1, y1, range, shard, thread);
    });
    finish_norm(1);
  }
  parallel.run(shard_count(n, kUnit),
               [&](int shard, int) { finish_block(blocks_.back(), shard_range(n, kUnit, shard)); });
  dense_forward(parallel, n, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_,
                parameters + fc_bias_, false, psi);
}

// `d`, the gradient of the block's output, is masked by its ReLU and summed for the normalisations before it.
template <class T>
void ResNet<T>::add_block_sums(Block& block, int shard, Range samples, T* d) {
  const Conv<T>& conv = block.convs[1];
  const size_t at = samples.begin * conv.y_size(), count = samples.size() * conv.y_size();
  kernels<T>().relu_mask(count, d + at, block.y.data() + at);
  for (const int i : {1, 2})
    if (i == 1 || block.has_shortcut())
      block.norms[i].add_backward_rows(shard, d + at, block.z[i].data() + at, count / conv.out(), false);
}

template <class T>
void ResNet<T>::finish_norm_backward(Block& block, int i, const T* parameters, T* gradient) {
  const Conv<T>& conv = block.convs[i];
  block.norms[i].finish_backward(n_ * conv.y_size() / conv.out(), parameters + block.places[i].scale,
                                 gradient + block.places[i].scale, gradient + block.places[i].shift);
}

template <class T>
void ResNet<T>::weight_gradients(Parallel& parallel, Block& block, std::initializer_list<int> convs, Range samples,
                                 T* gradient) {
  std::vector<std::pair<int, int>> shards;
  for (const int i : convs)
    for (int shard = 0; shard < block.convs[i].gradient_shards(); ++shard) shards.emplace_back(i, shard);
  parallel.run(int(shards.size()), [&](int number, int) {
    const auto [i, shard] = shards[number];
    const Conv<T>& conv = block.convs[i];
    T* to = conv.transformed() ? block.dfactors[i].data() : gradient + block.weights[i];
    conv.weight_gradient(shard, slabs_[i], samples.size(), samples.begin > 0, to);
  });
}

// From d_ through the second convolution: dy1_, and what the first normalisation needs.
template <class T>
void ResNet<T>::backward_inner(Parallel& parallel, Block& block, const T* parameters, T* gradient) {
  const Conv<T>& conv = block.convs[1];
  const size_t size = conv.y_size(), rows = size / conv.out();
  const int unit = conv.unit();
  block.norms[0].begin_backward(shard_count(n_, unit));
  conv.reserve(slabs_[1], Conv<T>::kSlab);
  for (int begin = 0; begin < n_; begin += Conv<T>::kSlab) {
    const Range slab = {begin, std::min(n_, begin + Conv<T>::kSlab)};
    parallel.run(shard_count(slab.size(), unit), [&](int shard, int thread) {
      const Range part = shard_range(slab.size(), unit, shard);
      const size_t at = (begin + part.begin) * size, count = part.size() * rows;
      Scratch& scratch = scratch_[thread];
      const T* z = block.z[0].data() + at;
      T* dy1 = dy1_.data() + at;
      T* dz = scratch.picture.grow(part.size() * size);
      T* y1 = scratch.second.grow(part.size() * size);
      block.norms[1].apply_backward(d_.data() + at, block.z[1].data() + at, dz, count, false);
      kernels<T>().norm_relu(count, conv.out(), z, block.norms[0].scale(), block.norms[0].shift(), y1);
      conv.backward(slabs_[1], part, y1, dz, dy1, false, scratch.products);
      block.norms[0].add_backward_rows(begin / unit + shard, dy1, z, count, true);
    });
    weight_gradients(parallel, block, {1}, slab, gradient);
  }
  finish_norm_backward(block, 0, parameters, gradient);
}

// From dy1_ and d_ through the first convolution and the shortcut: d_ becomes the gradient of the block before, masked
// and summed.
template <class T>
void ResNet<T>::backward_outer(Parallel& parallel, size_t b, T* gradient) {
  Block& block = blocks_[b];
  const Conv<T>& conv = block.convs[0];
  const bool own = block.has_shortcut();
  const size_t size = conv.y_size(), rows = size / conv.out();
  const int unit = conv.unit();
  for (const int i : {0, 2})
    if (i == 0 || own) block.convs[i].reserve(slabs_[i], Conv<T>::kSlab);
  if (b > 0)
    for (BatchNorm<T>& norm : blocks_[b - 1].norms) norm.begin_backward(shard_count(n_, unit));
  T* dx = b == 0 ? nullptr : own ? dx_.data() : d_.data();
  for (int begin = 0; begin < n_; begin += Conv<T>::kSlab) {
    const Range slab = {begin, std::min(n_, begin + Conv<T>::kSlab)};
    parallel.run(shard_count(slab.size(), unit), [&](int shard, int thread) {
      const Range part = shard_range(slab.size(), unit, shard), samples = {begin + part.begin, begin + part.end};
      const size_t at = samples.begin * size, count = part.size() * rows;
      Scratch& scratch = scratch_[thread];
      const T* x = block_input(b) + samples.begin * conv.x_size();
      T* dx_part = dx ? dx + samples.begin * conv.x_size() : nullptr;
      T* dz = scratch.picture.grow(part.size() * size);
      block.norms[0].apply_backward(dy1_.data() + at, block.z[0].data() + at, dz, count, true);
      conv.backward(slabs_[0], part, x, dz, dx_part, !own, scratch.products);
      if (own) {
        block.norms[2].apply_backward(d_.data() + at, block.z[2].data() + at, dz, count, false);
        block.convs[2].backward(slabs_[2], part, x, dz, dx_part, true, scratch.products);
      }
      if (b > 0) add_block_sums(blocks_[b - 1], begin / unit + shard, samples, dx);
    });
    if (own)
      weight_gradients(parallel, block, {0, 2}, slab, gradient);
    else
      weight_gradients(parallel, block, {0}, slab, gradient);
  }
  if (own) std::swap(d_, dx_);
}

template <class T>
void ResNet<T>::backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) {
  for (Buffer<T>* buffer : {&d_, &dx_, &dy1_}) buffer->grow(n_ * largest_);
  for (Block& block : blocks_)
    for (size_t i = 0; i < block.convs.size(); ++i)
      if (block.convs[i].transformed()) block.dfactors[i].grow(block.convs[i].dfactors_size());
  std::fill_n(gradient + fc_weight_, flat_ * feature_, T(0));
  std::fill_n(gradient + fc_bias_, feature_, T(0));
  dense_backward<T>(parallel, n_, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_, nullptr, dpsi,
                    d_.data(), false, gradient + fc_weight_, gradient + fc_bias_);
  for (BatchNorm<T>& norm : blocks_.back().norms) norm.begin_backward(shard_count(n_, kUnit));
  parallel.run(shard_count(n_, kUnit), [&](int shard, int) {
    add_block_sums(blocks_.back(), shard, shard_range(n_, kUnit, shard), d_.data());
  });
  for (size_t b = blocks_.size(); b-- > 0;) {
    Block& block = blocks_[b];
    finish_norm_backward(block, 1, parameters, gradient);
    if (block.has_shortcut()) finish_norm_backward(block, 2, parameters, gradient);
    backward_inner(parallel, block, parameters, gradient);
    backward_outer(parallel, b, gradient);
  }
  struct Part {
    const Conv<T>* conv;
    int tap;
    const T* dfactors;
    T* dweight;
  };
  std::vector<Part> parts;
  for (size_t b = blocks_.size(); b-- > 0;)
    for (size_t i = 0; i < blocks_[b].convs.size(); ++i)
      for (int tap = 0; blocks_[b].convs[i].transformed() && tap < Conv<T>::kTaps; ++tap)
        parts.push_back({&blocks_[b].convs[i], tap, blocks_[b].dfactors[i].data(), gradient + blocks_[b].weights[i]});
  parallel.run(int(parts.size()), [&](int shard, int) {
    const Part& part = parts[shard];
    part.conv->finish_gradient(part.tap, part.dfactors, part.dweight);
  });
}

template class ResNet<float>;
template class ResNet<double>;

}  // namespace synpo
