// The state feature psi(s) of GridWorld: the residual network of Table 2.
//
// Four stages of two basic blocks (3x3 conv, norm, ReLU, 3x3 conv, norm, plus the shortcut, ReLU), first strides 2 2 2
// 1, then a dense layer. A 1x1 convolution with normalisation stands on a shortcut that changes shape.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "nn/layers/conv.h"
#include "nn/layers/norm.h"
#include "nn/layout.h"
#include "policy/encoder/encoder.h"
#include "world/grid/view.h"

namespace synpo {

template <class T>
class ResNet : public Encoder<T> {
 public:
  // Appends its tensors to the two layouts, under `encoder.`.
  ResNet(const std::vector<int>& channels, int feature, bool normalise_input, Layout& parameters, Layout& statistics);

  // Pictures [16, 16, history] of colour indices.
  size_t observation_size() const override { return size_t(kGridCells) * kHistory; }

  // Convolutions as PyTorch does by default, the dense layer Xavier uniform, norms 1 and 0.
  void initialise(uint64_t seed, T* parameters, T* statistics) const override;

  void forward(Parallel& parallel, int n, const uint8_t* pictures, const T* parameters, T* statistics, T* psi,
               bool frozen) override;
  void backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) override;

  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) override;
  void infer(int thread, int n, const uint8_t* pictures, T* psi) override;

  size_t multiply_adds() const override;

 private:
  struct NormPlace {
    size_t scale, shift, mean, variance;
  };
  struct Block {
    std::vector<Conv<T>> convs;  // conv1, conv2 and, where the shape changes, the shortcut's
    size_t weights[3];
    NormPlace places[3];
    BatchNorm<T> norms[3];
    std::vector<T> frozen[3];  // scale, then shift, for inference
    Buffer<T> z[3],
        y;  // outputs of the convolutions; after the last ReLU. What is after the inner one is made anew where needed
    Buffer<T> dfactors[3];  // gradients of transformed weights
    bool has_shortcut() const { return convs.size() == 3; }
  };
  void expand(int n, const uint8_t* pictures, const T* mean, const T* inverse_sd, T* x) const;
  void freeze_input(const T* statistics);
  void normalise_input(Parallel& parallel, int n, const uint8_t* pictures, T* statistics);
  void prepare_convs(Parallel& parallel, const T* parameters, bool training);
  void finish_block(Block& block, Range samples);
  void backward_inner(Parallel& parallel, Block& block, const T* parameters, T* gradient);
  void backward_outer(Parallel& parallel, size_t b, T* gradient);
  void weight_gradients(Parallel& parallel, Block& block, std::initializer_list<int> convs, Range samples, T* gradient);
  void add_block_sums(Block& block, int shard, Range samples, T* d);
  void finish_norm_backward(Block& block, int i, const T* parameters, T* gradient);
  const T* block_input(size_t b) const { return b == 0 ? input_.data() : blocks_[b - 1].y.data(); }

  static constexpr size_t kInputSize = size_t(kGridCells) * kViewChannels;  // of one sample

  int feature_;
  bool normalise_input_;
  std::vector<Block> blocks_;
  size_t fc_weight_, fc_bias_, input_mean_ = 0, input_variance_ = 0;
  size_t flat_ = 0;     // inputs of the dense layer
  size_t largest_ = 0;  // values of the largest picture behind the first convolution
  int n_ = 0;
  Buffer<T> input_, d_, dx_,
      dy1_;  // gradients of a block's output, of its input where that has another shape, and behind its inner ReLU
  std::vector<T> input_shift_, input_scale_;  // per channel of the input
  typename Conv<T>::Slab slabs_[3];           // of a block's convolutions
  struct Scratch {
    Buffer<T> products, picture, second;
  };
  std::vector<Scratch> scratch_;  // a thread's own
  Packed<T> fc_packed_;           // for inference
  std::vector<T> fc_bias_values_;
};

extern template class ResNet<float>;
extern template class ResNet<double>;

}  // namespace synpo
