// The state feature psi(s) of pictures: the residual network of Table 2.
//
// Four stages of two basic blocks (3x3 conv, norm, ReLU, 3x3 conv, norm, plus the shortcut, ReLU), first strides 2 2 2
// 1, then a dense layer. A 1x1 convolution with normalisation stands on a shortcut that changes shape.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/rgb.h"
#include "kernel/kernels.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/residual_block.h"
#include "nn/layout.h"
#include "policy/encoder/encoder.h"
#include "world/observation.h"

namespace synpo {

template <class T>
class ResNet : public Encoder<T> {
 public:
  // Appends its tensors to the two layouts, under `encoder.`.
  ResNet(const ObservationSpec& observation, const std::vector<int>& channels, int feature, bool normalise_input,
         Layout& parameters, Layout& statistics);

  size_t observation_size() const override { return pixels() * kHistory; }

  // Convolutions as PyTorch does by default, the dense layer Xavier uniform, norms 1 and 0.
  void initialise(uint64_t seed, T* parameters, T* statistics) const override;

  void forward(Parallel& parallel, int n, const uint8_t* pictures, const T* parameters, T* statistics, T* psi,
               bool frozen) override;
  void backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) override;

  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) override;
  void infer(int thread, int n, const uint8_t* pictures, T* psi) override;

  size_t multiply_adds() const override;

 private:
  void expand(int n, const uint8_t* pictures, T* x) const;
  void freeze_input(const T* statistics);
  void normalise_input(Parallel& parallel, int n, const uint8_t* pictures, T* statistics);
  void prepare_blocks(Parallel& parallel, const T* parameters, bool training);

  size_t pixels() const { return size_t(side_) * side_; }
  size_t input_size() const { return pixels() * kChannels; }  // of one sample

  static constexpr int kChannels = ObservationSpec::kChannels;
  int side_, feature_;
  std::vector<Rgb> palette_;
  bool normalise_input_;
  std::vector<ResidualBlock<T>> blocks_;
  size_t fc_weight_, fc_bias_, input_mean_ = 0, input_variance_ = 0;
  size_t flat_ = 0;     // inputs of the dense layer
  size_t largest_ = 0;  // values of the largest output of a block
  int n_ = 0;
  Buffer<T> input_;
  std::vector<T> input_shift_, input_scale_;  // per channel of the input
  ResidualWorkspace<T> work_;
  Packed<T> fc_packed_;  // for inference
  std::vector<T> fc_bias_values_;
};

extern template class ResNet<float>;
extern template class ResNet<double>;

}  // namespace synpo
