// The basic block of a residual network (He et al. 2016): 3x3 convolution, normalisation, ReLU, 3x3 convolution,
// normalisation, plus the shortcut, ReLU. Where the shape changes, a 1x1 convolution with a normalisation of its own
// stands on the shortcut.
//
// Blocks are fused where they meet: a block's last pass over its output (normalisation, addition, ReLU) is made as the
// next block reads it, sample by sample while it is in the cache, and so is the mask of its last ReLU on the way back.
//
// Where there are more threads than that keeps busy, a convolution is done in stages over the whole batch (conv.h):
// slower for few threads, since everything passes through memory, and to the same bits, since no sum is cut anew.
#pragma once
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/conv.h"
#include "nn/layers/norm.h"
#include "nn/layout.h"

namespace synpo {

// Pictures [n, side, side, channels] that are written as they are first read: make(samples) before `values` of those.
template <class T>
struct LazyPictures {
  const T* values;
  std::function<void(Range samples)> make;
};

// Work that threads may take in any order.
using Jobs = std::vector<std::function<void()>>;
void run_jobs(Parallel& parallel, const Jobs& jobs);

// Memory that the blocks of a network use one after the other.
template <class T>
struct ResidualWorkspace {
  struct Scratch {
    Buffer<T> products, picture, second;
  };
  std::vector<Scratch> scratch;     // a thread's own
  typename Conv<T>::Slab slabs[3];  // of a block's convolutions
  Buffer<T> d, dx,
      dy1;  // gradients of a block's output, of its input where that has another shape, and of its inner ReLU
  void use_threads(int threads) {
    if (scratch.size() < size_t(threads)) scratch.resize(size_t(threads));
  }
};

template <class T>
class ResidualBlock {
 public:
  // Input [side, side, in], output [side / stride, side / stride, out]. Appends its tensors to the layouts:
  // NAME.conv1.weight, NAME.norm1.scale and so on.
  ResidualBlock(const std::string& name, int side, int in, int out, int stride, Layout& parameters, Layout& statistics);

  int side_out() const { return inner().side_out(); }
  int out() const { return inner().out(); }
  size_t x_size() const { return inner().x_size(); }  // of one sample
  size_t y_size() const { return inner().y_size(); }
  size_t multiply_adds() const;  // of one sample's forward pass, as executed

  // Convolutions as PyTorch does by default, norms 1 and 0.
  void initialise(InitStream& stream, T* parameters, T* statistics) const;

  // Appends the jobs that take the weights over, due after every change of them and before anything that follows;
  // without `training`, for infer() alone.
  void add_preparations(Jobs& jobs, const T* parameters, bool training);

  // Training, forward: n samples. Where `frozen`, normalisation takes the running statistics, which stay; else they
  // move. x.values has to live until backward().
  void forward(Parallel& parallel, ResidualWorkspace<T>& work, int n, const LazyPictures<T>& x, const T* parameters,
               T* statistics, bool frozen);
  // The outputs of the last forward().
  LazyPictures<T> output();

  // Training, backward. First, work.d [n, y_size()] becomes the gradient before the last ReLU, on all threads: for a
  // network's last block. Then work.d becomes the gradient of the input, masked for `before`, whose output that is;
  // without a block before, it is left undefined. Writes the gradients of the normalisations.
  void begin_backward(Parallel& parallel, ResidualWorkspace<T>& work);
  void backward(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before, const T* parameters,
                T* gradient);
  // Appends the jobs that finish the gradients of the convolutions' weights.
  void add_weight_gradients(Jobs& jobs, T* gradient) const;

  // Inference: takes over the running statistics.
  void prepare_inference(const T* parameters, const T* statistics);
  // One thread's part: y [n, y_size()] of x [n, x_size()]. `spare` are three places of n y_size() values.
  void infer(int n, const T* x, T* y, T* const spare[3], Buffer<T>& products) const;

 private:
  enum Place { kFirst, kSecond, kShortcut };
  struct NormPlace {
    size_t scale, shift, mean, variance;
  };
  const Conv<T>& inner() const { return convs_[kFirst]; }
  bool has_shortcut() const { return convs_.size() > kShortcut; }
  size_t places() const { return convs_.size(); }
  size_t pixels() const { return size_t(side_out()) * side_out(); }
  void convolve(Place i, ResidualWorkspace<T>& work, const T* from, Range samples, int shard, int thread,
                const T* statistics, bool frozen);
  void finish_norm(Place i, const T* parameters, T* statistics, bool frozen);
  void finish_output(Range samples);
  void mask_gradient(int shard, Range samples, T* d);
  void finish_norm_backward(Place i, const T* parameters, T* gradient);
  void weight_gradients(Parallel& parallel, ResidualWorkspace<T>& work, std::initializer_list<Place> convs,
                        Range samples, T* gradient);
  // Whether `samples` are too few for the threads, a unit each.
  bool staged(const Parallel& parallel, int samples) const {
    return parallel.threads() > 2 && shard_count(samples, inner().unit()) < 2 * parallel.threads();
  }
  // count(conv) shards of each convolution, all at once: body(place, shard).
  template <class Count, class Body>
  void run_shards(Parallel& parallel, std::initializer_list<Place> convs, Count&& count, Body&& body);
  void run_stages(Parallel& parallel, ResidualWorkspace<T>& work, std::initializer_list<Place> convs, const T* x,
                  const T* statistics, bool frozen);
  void stage_gradients(Parallel& parallel, ResidualWorkspace<T>& work, std::initializer_list<Place> convs, int samples,
                       bool dx);
  void forward_staged(Parallel& parallel, ResidualWorkspace<T>& work, const LazyPictures<T>& x, const T* parameters,
                      T* statistics, bool frozen);
  void backward_second_staged(Parallel& parallel, ResidualWorkspace<T>& work, Range slab);
  void backward_first_staged(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before, Range slab, T* dx);
  void backward_second(Parallel& parallel, ResidualWorkspace<T>& work, const T* parameters, T* gradient);
  void backward_first(Parallel& parallel, ResidualWorkspace<T>& work, ResidualBlock* before, T* gradient);

  std::vector<Conv<T>> convs_;  // first, second and, where the shape changes, the shortcut's
  size_t weights_[3];
  NormPlace norm_places_[3];
  BatchNorm<T> norms_[3];
  std::vector<T> frozen_[3];  // scale, then shift, for inference
  int n_ = 0;
  const T* x_ = nullptr;
  // Outputs of the convolutions, and of the last ReLU. Those of the inner ReLU are made anew where they are needed.
  Buffer<T> z_[3], y_;
  Buffer<T> dfactors_[3];  // gradients of transformed weights
};

extern template class ResidualBlock<float>;
extern template class ResidualBlock<double>;

}  // namespace synpo
