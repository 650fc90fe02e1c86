#include "policy/encoder/resnet.h"

#include <algorithm>
#include <cmath>

#include "nn/init.h"

namespace synpo {
template <class T>
ResNet<T>::ResNet(const std::vector<int>& channels, int feature, bool normalise_input, Layout& parameters,
                  Layout& statistics)
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
      const auto add_conv = [&](const std::string& conv, const std::string& norm, int conv_side, int conv_in,
                                int kernel, int conv_stride) {
        const size_t i = block.convs.size();
        block.convs.emplace_back(conv_side, conv_in, out, kernel, conv_stride);
        const std::vector<int> shape =
            kernel == 1 ? std::vector<int>{conv_in, out} : std::vector<int>{3, 3, conv_in, out};
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
  InitStream stream(seed, 0);
  for (const Block& block : blocks_)
    for (size_t i = 0; i < block.convs.size(); ++i) {
      const Conv<T>& conv = block.convs[i];
      // kaiming_uniform with a = sqrt(5), PyTorch's default, is uniform within 1 / sqrt(inputs).
      stream.uniform(parameters + block.weights[i], conv.weight_size(),
                     1 / std::sqrt(double(conv.weight_size()) / conv.out()));
      std::fill_n(parameters + block.places[i].scale, conv.out(), T(1));
      std::fill_n(parameters + block.places[i].shift, conv.out(), T(0));
      std::fill_n(statistics + block.places[i].mean, conv.out(), T(0));
      std::fill_n(statistics + block.places[i].variance, conv.out(), T(1));
    }
  stream.uniform(parameters + fc_weight_, flat_ * feature_, xavier_bound(int(flat_), feature_));
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
void ResNet<T>::prepare_convs(Parallel& parallel, const T* parameters, bool training) {
  struct Part {
    Conv<T>* conv;
    int product;
    size_t weight;
  };
  std::vector<Part> parts;
  for (size_t b = blocks_.size(); b-- > 0;)  // the largest first, so that threads end together
    for (size_t i = 0; i < blocks_[b].convs.size(); ++i)
      for (int p = 0; p < blocks_[b].convs[i].products(); ++p)
        parts.push_back({&blocks_[b].convs[i], p, blocks_[b].weights[i]});
  parallel.run(int(parts.size()), [&](int shard, int) {
    const Part& part = parts[shard];
    part.conv->prepare(part.product, parameters + part.weight, training);
  });
  scratch_.resize(std::max<size_t>(scratch_.size(), parallel.threads()));
}

template <class T>
void ResNet<T>::freeze_input(const T* statistics) {
  for (int c = 0; c < kViewChannels; ++c) {
    input_shift_[c] = statistics[input_mean_ + c];
    input_scale_[c] = T(1 / std::sqrt(statistics[input_variance_ + c] + kNormEpsilon));
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
      frozen_norm(count, parameters + place.scale, parameters + place.shift, statistics + place.mean,
                  statistics + place.variance, block.frozen[i].data(), block.frozen[i].data() + count);
    }
  if (normalise_input_) freeze_input(statistics);
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
    kernels<T>().norm_add_relu(rows, out, spare[1], scale(1), shift(1), own ? spare[2] : x, own ? scale(2) : nullptr,
                               own ? shift(2) : nullptr, next);
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
