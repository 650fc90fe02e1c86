// The state feature psi(s) of the kitchens: the temporal network of Table 3.
//
// Two convolutions over time, kernel 3, stride 2, padding 1, each with ReLU: 2048 x 4 -> 1024 x 2 -> 1024 x 1. Then
// comes the embedding of the object in the hand, and a perceptron: 1056 -> 2048 ReLU -> 256. A padded view is zero,
// so of the taps of the first convolution five are multiplied, and of the second one's two: its first never is.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "kernel/kernels.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/layers/perceptron.h"
#include "nn/layout.h"
#include "policy/encoder/encoder.h"
#include "policy/temporal_sizes.h"
#include "world/observation.h"

namespace synpo {

template <class T>
class TemporalNet : public Encoder<T> {
 public:
  // Appends its tensors to the layout, under `encoder.`.
  TemporalNet(const ObservationSpec& observation, const TemporalSizes& sizes, int feature, Layout& parameters);

  size_t observation_size() const override { return row() * sizeof(float); }

  // Convolutions as PyTorch does by default, dense layers Xavier uniform, the objects' embeddings N(0, 1).
  void initialise(uint64_t seed, T* parameters, T* statistics) const override;

  void forward(Parallel& parallel, int n, const uint8_t* observations, const T* parameters, T* statistics, T* psi,
               bool frozen) override;
  void backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) override;

  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) override;
  void infer(int thread, int n, const uint8_t* observations, T* psi) override;

  size_t multiply_adds() const override;

 private:
  static constexpr int kTaps = 3;
  // A convolution's weight is [taps, in, channels].
  struct Convolution {
    int in;
    size_t weight, bias;
  };
  size_t tap_offset(const Convolution& c, int tap) const { return c.weight + size_t(tap) * c.in * sizes_.channels; }
  size_t views() const { return size_t(kHistory) * view_; }                // values of an observation's views
  size_t row() const { return views() + ObservationSpec::kObjectFloats; }  // values of an observation
  int joined_width() const { return sizes_.channels + sizes_.object_embedding; }
  // The values [n, row()] of observations: where they stand, or copied to `own`.
  const T* values(int n, const uint8_t* observations, Buffer<T>& own) const;
  void pack_first(Parallel& parallel, const T* parameters, Packed<T>* taps) const;
  // The first convolution of some states, to y1 [n, 2, channels].
  void convolve(int n, const T* x, const Packed<T>* taps, const T* bias, T* y1) const;
  // The embedding of each state's object, from objects [objects, object_embedding], to joined [n, joined_width()],
  // where it follows the second convolution's outputs.
  void put_objects(int n, const T* x, const T* objects, T* joined) const;

  int view_, object_count_;  // of ObservationSpec
  TemporalSizes sizes_;
  int feature_;
  Convolution first_, second_;
  size_t objects_;
  Perceptron<T> fc_;
  size_t end_;  // of the encoder's tensors
  int n_ = 0;
  const T* x_ = nullptr;
  Buffer<T> own_, y1_, y2_, joined_, dy1_, dy2_, djoined_;
  Packed<T> taps_[kTaps], dy1_packed_[2];
  // For inference.
  struct Scratch {
    Buffer<T> own, y1, joined, hidden;
  };
  std::vector<Scratch> scratch_;  // a thread's own
  Packed<T> infer_taps_[kTaps], infer_second_;
  std::vector<T> bias_values_, object_values_;
};

extern template class TemporalNet<float>;
extern template class TemporalNet<double>;

}  // namespace synpo
