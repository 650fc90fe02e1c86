#include "torch/network.h"
#include "torch/parts.h"

namespace synpo {
namespace {

constexpr double kNormEpsilon = 1e-5, kNormMomentum = 0.1;  // nn/layers/norm.h
constexpr double kPixelScale = 1.0 / 64;                    // policy/encoder/resnet.cc

// Activations of the encoder are kept in this type.
torch::ScalarType activation(const NetworkSizes& sizes) {
  return sizes.precision == TorchPrecision::kBf16 ? torch::kBFloat16 : torch::kFloat32;
}

// Table 2: residual blocks over pictures, [n, channels, side, side] with the channels innermost in memory.
class ResNetPass {
 public:
  ResNetPass(const NetworkSizes& sizes, const Views& w, const Views& statistics, bool frozen)
      : sizes_(sizes), w_(w), statistics_(statistics), frozen_(frozen) {}

  torch::Tensor run(const torch::Tensor& observations) const {
    static constexpr int strides[4] = {2, 2, 2, 1};
    torch::Tensor x = expand(observations);
    for (int stage = 0; stage < 4; ++stage)
      for (int block = 0; block < 2; ++block)
        x = residual(x, "encoder.stage" + std::to_string(stage + 1) + ".block" + std::to_string(block + 1),
                     block == 0 ? strides[stage] : 1);
    const torch::Tensor flat = x.permute({0, 2, 3, 1}).flatten(1);
    return product(flat, w_["encoder.fc.weight"], activation(sizes_)) + w_["encoder.fc.bias"];
  }

 private:
  // Colour numbers [n, side * side, history] become values.
  torch::Tensor expand(const torch::Tensor& observations) const {
    const int64_t n = observations.size(0);
    const torch::Tensor place = torch::arange(sizes_.history, observations.options().dtype(torch::kInt32));
    const torch::Tensor number =
        (observations.view({-1, sizes_.history}).to(torch::kInt32) + place * sizes_.colours).flatten();
    const torch::Tensor table = sizes_.normalise_input ? sizes_.palette : sizes_.palette * kPixelScale;
    torch::Tensor x = table.index_select(0, number).view({n, sizes_.side, sizes_.side, 3 * sizes_.history});
    x = x.permute({0, 3, 1, 2});
    if (sizes_.normalise_input)
      x = torch::batch_norm(x, {}, {}, statistics_["encoder.input.mean"], statistics_["encoder.input.variance"],
                            !frozen_, kNormMomentum, kNormEpsilon, false);
    return x.to(activation(sizes_));
  }

  torch::Tensor norm(const torch::Tensor& x, const std::string& name) const {
    return torch::batch_norm(x, w_[name + ".scale"], w_[name + ".shift"], statistics_[name + ".mean"],
                             statistics_[name + ".variance"], !frozen_, kNormMomentum, kNormEpsilon, true);
  }

  // A checkpoint's weight is [kernel, kernel, in, out], or [in, out] for a kernel of 1.
  torch::Tensor convolve(const torch::Tensor& x, const torch::Tensor& weight, int64_t stride) const {
    const bool point = weight.dim() == 2;
    const torch::Tensor kernel = (point ? weight.view({1, 1, weight.size(0), weight.size(1)}) : weight)
                                     .to(activation(sizes_))
                                     .permute({3, 2, 0, 1});
    return torch::conv2d(x, kernel.contiguous(torch::MemoryFormat::ChannelsLast), {}, stride, point ? 0 : 1);
  }

  torch::Tensor residual(const torch::Tensor& x, const std::string& name, int64_t stride) const {
    torch::Tensor y = norm(convolve(x, w_[name + ".conv1.weight"], stride), name + ".norm1").relu_();
    y = norm(convolve(y, w_[name + ".conv2.weight"], 1), name + ".norm2");
    const bool own = w_.has(name + ".shortcut.weight");
    const torch::Tensor shortcut =
        own ? norm(convolve(x, w_[name + ".shortcut.weight"], stride), name + ".shortcut_norm") : x;
    return y.add_(shortcut).relu_();
  }

  const NetworkSizes& sizes_;
  const Views &w_, &statistics_;
  bool frozen_;
};

// Table 3: two convolutions over the four views, the oldest first, as products without what is padding
// (policy/encoder/temporal_net.h).
torch::Tensor temporal(const NetworkSizes& sizes, const Views& w, const torch::Tensor& observations) {
  const int64_t view = sizes.view, views = sizes.history * view;
  const torch::ScalarType type = activation(sizes);
  const torch::Tensor &first = w["encoder.conv1.weight"], &second = w["encoder.conv2.weight"];
  const torch::Tensor early = product(observations.narrow(1, 0, 2 * view), first.narrow(0, 1, 2).flatten(0, 1), type);
  const torch::Tensor late = product(observations.narrow(1, view, 3 * view), first.flatten(0, 1), type);
  const torch::Tensor& bias = w["encoder.conv1.bias"];
  const torch::Tensor between = torch::cat({(early + bias).relu(), (late + bias).relu()}, 1);
  const torch::Tensor seen =
      (product(between, second.narrow(0, 1, 2).flatten(0, 1), type) + w["encoder.conv2.bias"]).relu();
  const torch::Tensor held = observations.select(1, views).to(torch::kInt64);
  const torch::Tensor joined = torch::cat({seen, take_rows(w["encoder.object"], held)}, 1);
  return perceptron(w, "encoder.fc", joined, type);
}

}  // namespace

torch::Tensor encode(const NetworkSizes& sizes, const Views& w, const Views& statistics,
                     const torch::Tensor& observations, bool frozen) {
  if (sizes.features) return temporal(sizes, w, observations);
  return ResNetPass(sizes, w, statistics, frozen).run(observations);
}

}  // namespace synpo
