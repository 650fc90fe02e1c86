#include "policy/resnet.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "nn/dense.h"
#include "nn/gemm.h"

namespace synpo {
namespace {
constexpr int kUnit = 32;  // samples of a shard where no convolution asks for another number
constexpr size_t kInputSize = size_t(kGridCells) * kViewChannels;
}  // namespace

template <class T>
ResNet<T>::ResNet(const std::vector<int>& channels, int feature, bool normalise_input, Layout& parameters, Layout& statistics)
    : feature_(feature), normalise_input_(normalise_input) {
  static constexpr int strides[4] = {2, 2, 2, 1};
  const auto add_norm = [&](const std::string& name, int count) {
    return NormPlace{parameters.add(name + ".scale", {count}), parameters.add(name + ".shift", {count}),
                     statistics.add(name + ".mean", {count}), statistics.add(name + ".variance", {count})};
  };
  if (normalise_input_) {
    input_mean_ = statistics.add("encoder.input.mean", {kViewChannels});
    input_variance_ = statistics.add("encoder.input.variance", {kViewChannels});
  }
  int side = kGridSide, in = kViewChannels;
  for (int stage = 0; stage < 4; ++stage)
    for (int b = 0; b < 2; ++b) {
      const int out = channels[stage], stride = b == 0 ? strides[stage] : 1;
      const std::string name = "encoder.stage" + std::to_string(stage + 1) + ".block" + std::to_string(b + 1);
      Block block;
      const auto add_conv = [&](const std::string& conv, const std::string& norm, int conv_side, int conv_in, int kernel, int conv_stride) {
        const size_t i = block.convs.size();
        block.convs.emplace_back(conv_side, conv_in, out, kernel, conv_stride);
        const std::vector<int> shape = kernel == 1 ? std::vector<int>{conv_in, out} : std::vector<int>{3, 3, conv_in, out};
        block.weights[i] = parameters.add(name + "." + conv + ".weight", shape);
        block.places[i] = add_norm(name + "." + norm, out);
        block.norms[i] = BatchNorm<T>(out);
      };
      add_conv("conv1", "norm1", side, in, 3, stride);
      const int side_out = block.convs[0].side_out();
      add_conv("conv2", "norm2", side_out, out, 3, 1);
      if (stride != 1 || in != out) add_conv("shortcut", "shortcut_norm", side, in, 1, stride);
      side = side_out;
      in = out;
      largest_ = std::max(largest_, size_t(side) * side * out);
      blocks_.push_back(std::move(block));
    }
  flat_ = size_t(side) * side * in;
  fc_weight_ = parameters.add("encoder.fc.weight", {int(flat_), feature});
  fc_bias_ = parameters.add("encoder.fc.bias", {feature});
  input_shift_.assign(kViewChannels, 0);
  input_scale_.assign(kViewChannels, T(kPixelScale));
}

template <class T>
void ResNet<T>::initialise(uint64_t seed, T* parameters, T* statistics) const {
  uint64_t tensor = 0;
  const auto uniform = [&](size_t at, size_t count, double bound) {
    Random random(seed, Purpose::kInit, 0, tensor++);
    for (size_t i = 0; i < count; ++i) parameters[at + i] = T(bound * (2 * random.uniform() - 1));
  };
  for (const Block& block : blocks_)
    for (size_t i = 0; i < block.convs.size(); ++i) {
      const Conv<T>& conv = block.convs[i];
      // kaiming_uniform with a = sqrt(5), PyTorch's default, is uniform within 1 / sqrt(inputs).
      uniform(block.weights[i], conv.weight_size(), 1 / std::sqrt(double(conv.weight_size()) / conv.out()));
      std::fill_n(parameters + block.places[i].scale, conv.out(), T(1));
      std::fill_n(parameters + block.places[i].shift, conv.out(), T(0));
      std::fill_n(statistics + block.places[i].mean, conv.out(), T(0));
      std::fill_n(statistics + block.places[i].variance, conv.out(), T(1));
    }
  uniform(fc_weight_, flat_ * feature_, std::sqrt(6.0 / (flat_ + feature_)));
  std::fill_n(parameters + fc_bias_, feature_, T(0));
  if (normalise_input_) {
    std::fill_n(statistics + input_mean_, kViewChannels, T(0));
    std::fill_n(statistics + input_variance_, kViewChannels, T(1));
  }
}

template <class T>
void ResNet<T>::expand(int n, const uint8_t* pictures, const T* shift, const T* scale, T* x) const {
  // Value of every (frame, colour), [history, colours, 3].
  T values[kHistory][kGridColours][3];
  for (int f = 0; f < kHistory; ++f)
    for (int colour = 0; colour < kGridColours; ++colour) {
      const uint8_t rgb[3] = {kPalette[colour].r, kPalette[colour].g, kPalette[colour].b};
      for (int i = 0; i < 3; ++i) values[f][colour][i] = (rgb[i] - shift[3 * f + i]) * scale[3 * f + i];
    }
  for (size_t at = 0; at < size_t(n) * kGridCells * kHistory; ++at)
    std::copy_n(values[at % kHistory][pictures[at]], 3, x + 3 * at);
}

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
void ResNet<T>::prepare_convs(Parallel& parallel, const T* parameters, bool training) {
  struct Part {
    Conv<T>* conv;
    int product;
    size_t weight;
  };
  std::vector<Part> parts;
  for (size_t b = blocks_.size(); b-- > 0;)  // the largest first, so that threads end together
    for (size_t i = 0; i < blocks_[b].convs.size(); ++i)
      for (int p = 0; p < blocks_[b].convs[i].products(); ++p) parts.push_back({&blocks_[b].convs[i], p, blocks_[b].weights[i]});
  parallel.run(int(parts.size()), [&](int shard, int) {
    const Part& part = parts[shard];
    part.conv->prepare(part.product, parameters + part.weight, training);
  });
  scratch_.resize(std::max<size_t>(scratch_.size(), parallel.threads()));
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
                             own ? block.norms[2].scale() : nullptr, own ? block.norms[2].shift() : nullptr, block.y.data() + at);
}

template <class T>
void ResNet<T>::forward(Parallel& parallel, int n, const uint8_t* pictures, const T* parameters, T* statistics, T* psi) {
  n_ = n;
  prepare_convs(parallel, parameters, true);
  if (normalise_input_) normalise_input(parallel, n, pictures, statistics);
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
      block.norms[i].add_rows(shard, z, size_t(range.size()) * pixels, statistics + block.places[i].mean);
    };
    const auto finish_norm = [&](int i) {
      const NormPlace& place = block.places[i];
      block.norms[i].finish(size_t(n) * pixels, parameters + place.scale, parameters + place.shift, statistics + place.mean,
                            statistics + place.variance);
    };
    for (size_t i = 0; i < block.convs.size(); ++i) block.norms[i].begin(shards);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(n, unit, shard);
      if (b == 0)
        expand(range.size(), pictures + size_t(range.begin) * kGridCells * kHistory, input_shift_.data(), input_scale_.data(),
               input_.data() + range.begin * kInputSize);
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
      kernels<T>().norm_relu(size_t(range.size()) * pixels, block.convs[0].out(), block.z[0].data() + range.begin * size,
                             block.norms[0].scale(), block.norms[0].shift(), y1);
      convolve(1, y1, range, shard, thread);
    });
    finish_norm(1);
  }
  parallel.run(shard_count(n, kUnit), [&](int shard, int) { finish_block(blocks_.back(), shard_range(n, kUnit, shard)); });
  dense_forward(parallel, n, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_, parameters + fc_bias_, false, psi);
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
  block.norms[i].finish_backward(n_ * conv.y_size() / conv.out(), parameters + block.places[i].scale, gradient + block.places[i].scale,
                                 gradient + block.places[i].shift);
}

template <class T>
void ResNet<T>::weight_gradients(Parallel& parallel, Block& block, std::initializer_list<int> convs, Range samples, T* gradient) {
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

// From dy1_ and d_ through the first convolution and the shortcut: d_ becomes the gradient of the block before, masked and summed.
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
  dense_backward<T>(parallel, n_, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_, nullptr, dpsi, d_.data(), false,
                    gradient + fc_weight_, gradient + fc_bias_);
  for (BatchNorm<T>& norm : blocks_.back().norms) norm.begin_backward(shard_count(n_, kUnit));
  parallel.run(shard_count(n_, kUnit), [&](int shard, int) { add_block_sums(blocks_.back(), shard, shard_range(n_, kUnit, shard), d_.data()); });
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

template <class T>
void ResNet<T>::prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) {
  prepare_convs(parallel, parameters, false);
  for (Block& block : blocks_)
    for (size_t i = 0; i < block.convs.size(); ++i) {
      const int count = block.convs[i].out();
      const NormPlace& place = block.places[i];
      block.frozen[i].resize(2 * count);
      frozen_norm(count, parameters + place.scale, parameters + place.shift, statistics + place.mean, statistics + place.variance,
                  block.frozen[i].data(), block.frozen[i].data() + count);
    }
  if (normalise_input_)
    for (int c = 0; c < kViewChannels; ++c) {
      input_shift_[c] = statistics[input_mean_ + c];
      input_scale_[c] = T(1 / std::sqrt(statistics[input_variance_ + c] + kNormEpsilon));
    }
  fc_packed_.pack(Op::kAsIs, int(flat_), feature_, parameters + fc_weight_, feature_);
  fc_bias_values_.assign(parameters + fc_bias_, parameters + fc_bias_ + feature_);
}

template <class T>
void ResNet<T>::infer(int thread, int n, const uint8_t* pictures, T* psi) {
  Buffer<T>& products = scratch_[thread].products;
  const size_t place = n * std::max(kInputSize, largest_);
  T* x = scratch_[thread].picture.grow(5 * place);
  T* next = x + place;
  T* spare[3] = {x + 2 * place, x + 3 * place, x + 4 * place};
  expand(n, pictures, input_shift_.data(), input_scale_.data(), x);
  for (const Block& block : blocks_) {
    const int out = block.convs[0].out();
    const size_t rows = size_t(n) * block.convs[0].side_out() * block.convs[0].side_out();
    const auto scale = [&](int i) { return block.frozen[i].data(); };
    const auto shift = [&](int i) { return block.frozen[i].data() + out; };
    block.convs[0].forward(n, x, spare[0], products);
    kernels<T>().norm_relu(rows, out, spare[0], scale(0), shift(0), spare[0]);
    block.convs[1].forward(n, spare[0], spare[1], products);
    const bool own = block.has_shortcut();
    if (own) block.convs[2].forward(n, x, spare[2], products);
    kernels<T>().norm_add_relu(rows, out, spare[1], scale(1), shift(1), own ? spare[2] : x, own ? scale(2) : nullptr, own ? shift(2) : nullptr,
                               next);
    std::swap(x, next);
  }
  gemm(Op::kAsIs, n, x, int(flat_), fc_packed_, psi, feature_);
  kernels<T>().add_bias(n, feature_, fc_bias_values_.data(), false, psi);
}

template <class T>
size_t ResNet<T>::multiply_adds() const {
  size_t sum = flat_ * feature_;
  for (const Block& block : blocks_)
    for (const Conv<T>& conv : block.convs) sum += conv.multiply_adds();
  return sum;
}

template class ResNet<float>;
template class ResNet<double>;

}  // namespace synpo
