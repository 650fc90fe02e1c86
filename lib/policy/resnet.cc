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
  for (Block& block : blocks_)
    for (size_t i = 0; i < block.convs.size(); ++i) block.convs[i].prepare(parallel, parameters + block.weights[i], training);
}

template <class T>
void ResNet<T>::finish_block(Block& block, Range samples) {
  const Conv<T>& conv = block.convs[1];
  const size_t at = samples.begin * conv.y_size();
  const size_t rows = size_t(samples.size()) * conv.side_out() * conv.side_out();
  const BatchNorm<T>& norm = block.norms[1];
  const bool own = block.has_shortcut();
  const T* shortcut = own ? block.z[2].data() : block_input(&block - blocks_.data());
  norm_add_relu(block.z[1].data() + at, norm.scale(), norm.shift(), shortcut + at, own ? block.norms[2].scale() : nullptr,
                own ? block.norms[2].shift() : nullptr, block.y.data() + at, rows, conv.out());
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
    block.y1.grow(n * block.convs[0].y_size());
    block.y.grow(n * block.convs[0].y_size());
    const T* x = block_input(b);
    const int unit = block.convs[0].unit(), shards = shard_count(n, unit);
    const int pixels = block.convs[0].side_out() * block.convs[0].side_out();
    work_.scratch.resize(std::max<size_t>(work_.scratch.size(), parallel.threads()));
    const auto convolve = [&](int i, const T* from, Range range, int shard, int thread) {
      const Conv<T>& conv = block.convs[i];
      T* z = block.z[i].data() + range.begin * conv.y_size();
      conv.forward(range.size(), from + range.begin * conv.x_size(), z, work_.scratch[thread]);
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
      convolve(0, x, range, shard, thread);
      if (block.has_shortcut()) convolve(2, x, range, shard, thread);
    });
    finish_norm(0);
    if (block.has_shortcut()) finish_norm(2);
    parallel.run(shards, [&](int shard, int thread) {
      const Range range = shard_range(n, unit, shard);
      const size_t at = range.begin * block.convs[0].y_size();
      norm_relu(block.z[0].data() + at, block.norms[0].scale(), block.norms[0].shift(), block.y1.data() + at,
                size_t(range.size()) * pixels, block.convs[0].out());
      convolve(1, block.y1.data(), range, shard, thread);
    });
    finish_norm(1);
  }
  parallel.run(shard_count(n, kUnit), [&](int shard, int) { finish_block(blocks_.back(), shard_range(n, kUnit, shard)); });
  dense_forward(parallel, n, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_, parameters + fc_bias_, false, psi);
}

template <class T>
void ResNet<T>::backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) {
  const int n = n_;
  T* d = d_.grow(n * largest_);
  T* dz = dz_.grow(n * largest_);
  T* dy1 = dy1_.grow(n * largest_);
  T* dshortcut = dshortcut_.grow(n * largest_);
  dense_backward<T>(parallel, n, int(flat_), feature_, blocks_.back().y.data(), parameters + fc_weight_, nullptr, dpsi, d, false,
                    gradient + fc_weight_, gradient + fc_bias_);
  for (size_t b = blocks_.size(); b-- > 0;) {
    Block& block = blocks_[b];
    const size_t size = block.convs[0].y_size();
    const int pixels = block.convs[0].side_out() * block.convs[0].side_out();
    const int shards = shard_count(n, kUnit);
    // Backward through a ReLU (whose output is y) and the normalisations behind it: `from` is masked, then each norm's dz is made.
    const auto through_norms = [&](T* from, const T* y, std::initializer_list<std::pair<int, T*>> norms) {
      for (const auto& [i, to] : norms) block.norms[i].begin_backward(shards);
      parallel.run(shards, [&](int shard, int) {
        const Range range = shard_range(n, kUnit, shard);
        const size_t at = range.begin * size;
        relu_mask(from + at, y + at, range.size() * size);
        for (const auto& [i, to] : norms)
          block.norms[i].add_backward_rows(shard, from + at, block.z[i].data() + at, size_t(range.size()) * pixels);
      });
      for (const auto& [i, to] : norms)
        block.norms[i].finish_backward(size_t(n) * pixels, parameters + block.places[i].scale, gradient + block.places[i].scale,
                                       gradient + block.places[i].shift);
      parallel.run(shards, [&](int shard, int) {
        const Range range = shard_range(n, kUnit, shard);
        const size_t at = range.begin * size;
        for (const auto& [i, to] : norms)
          block.norms[i].apply_backward(from + at, block.z[i].data() + at, to + at, size_t(range.size()) * pixels);
      });
    };
    const auto through_conv = [&](int i, const T* x, const T* from, T* dx, bool add) {
      block.convs[i].backward(parallel, n, x, from, dx, add, gradient + block.weights[i], work_);
    };
    if (block.has_shortcut())
      through_norms(d, block.y.data(), {{1, dz}, {2, dshortcut}});
    else
      through_norms(d, block.y.data(), {{1, dz}});
    through_conv(1, block.y1.data(), dz, dy1, false);
    through_norms(dy1, block.y1.data(), {{0, dy1}});
    // From here on d is the gradient of the block's input: an identity shortcut leaves it in place, to be added to.
    T* dx = b == 0 ? nullptr : d;
    through_conv(0, block_input(b), dy1, dx, !block.has_shortcut());
    if (block.has_shortcut()) through_conv(2, block_input(b), dshortcut, dx, true);
  }
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
  fc_.assign(parameters + fc_weight_, parameters + fc_weight_ + flat_ * feature_);
  fc_.insert(fc_.end(), parameters + fc_bias_, parameters + fc_bias_ + feature_);
  // One scratch a thread for products, one for pictures.
  work_.scratch.resize(std::max<size_t>(work_.scratch.size(), 2 * parallel.threads()));
}

template <class T>
void ResNet<T>::infer(int thread, int n, const uint8_t* pictures, T* psi) {
  Buffer<T>& products = work_.scratch[2 * thread];
  const size_t place = n * std::max(kInputSize, largest_);
  T* x = work_.scratch[2 * thread + 1].grow(5 * place);
  T* next = x + place;
  T* spare[3] = {x + 2 * place, x + 3 * place, x + 4 * place};
  expand(n, pictures, input_shift_.data(), input_scale_.data(), x);
  for (const Block& block : blocks_) {
    const int out = block.convs[0].out();
    const size_t rows = size_t(n) * block.convs[0].side_out() * block.convs[0].side_out();
    const auto scale = [&](int i) { return block.frozen[i].data(); };
    const auto shift = [&](int i) { return block.frozen[i].data() + out; };
    block.convs[0].forward(n, x, spare[0], products);
    norm_relu(spare[0], scale(0), shift(0), spare[0], rows, out);
    block.convs[1].forward(n, spare[0], spare[1], products);
    const bool own = block.has_shortcut();
    if (own) block.convs[2].forward(n, x, spare[2], products);
    norm_add_relu(spare[1], scale(1), shift(1), own ? spare[2] : x, own ? scale(2) : nullptr, own ? shift(2) : nullptr, next, rows, out);
    std::swap(x, next);
  }
  gemm(Op::kAsIs, Op::kAsIs, n, feature_, int(flat_), x, int(flat_), fc_.data(), feature_, psi, feature_);
  const T* bias = fc_.data() + flat_ * feature_;
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < feature_; ++c) psi[size_t(i) * feature_ + c] += bias[c];
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
