// The state feature psi(s) of the kitchens: the temporal network of Table 3.
//
// Two convolutions over time, kernel 3, stride 2, padding 1, each with ReLU: 2048 x 4 -> 1024 x 2 -> 1024 x 1. Behind it comes the embedding of the
// object in the hand, and a perceptron: 1056 -> 2048 ReLU -> 256. A padded view is zero, so of the taps of the first convolution five are
// multiplied, and of the second one's two: its first never is.
#pragma once
#include <string>
#include <vector>

#include "nn/gemm.h"
#include "nn/layout.h"
#include "nn/perceptron.h"
#include "policy/encoder.h"
#include "policy/temporal_sizes.h"

namespace synpo {

template <class T>
class TemporalNet : public Encoder<T> {
 public:
  // Appends its tensors to the layout, under `encoder.`.
  TemporalNet(const TemporalSizes& sizes, int feature, Layout& parameters);

  // float [history, view], oldest first, and kHandFloats more, the first of which is the number of the object in the hand.
  size_t observation_size() const override { return (size_t(kHistory) * sizes_.view + kHandFloats) * sizeof(float); }

  // Convolutions as PyTorch does by default, dense layers Xavier uniform, the objects' embeddings N(0, 1).
  void initialise(uint64_t seed, T* parameters, T* statistics) const override;

  void forward(Parallel& parallel, int n, const uint8_t* observations, const T* parameters, T* statistics, T* psi, bool frozen) override;
  void backward(Parallel& parallel, const T* parameters, T* dpsi, T* gradient) override;

  void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics) override;
  void infer(int thread, int n, const uint8_t* observations, T* psi) override;

  size_t multiply_adds() const override;

 private:
  static constexpr int kTaps = 3;
  // A convolution's weight [taps, in, channels], packed tap by tap.
  struct Convolution {
    int in;
    size_t weight, bias;
    Packed<T> taps[kTaps];
  };
  size_t tap_offset(const Convolution& c, int tap) const { return c.weight + size_t(tap) * c.in * sizes_.channels; }
  void pack(Parallel& parallel, const T* parameters);
  // For some states: views [n, history, view] and hands out of the observations, then both convolutions into y1 [n, 2, channels] and the first
  // columns of joined [n, joined_width()], whose last ones are the objects' embeddings.
  void unpack(int n, const uint8_t* observations, T* views, int* hands) const;
  void convolve(int n, const T* views, const int* hands, const T* biases, const T* objects, T* y1, T* joined) const;
  int joined_width() const { return sizes_.channels + sizes_.object_embedding; }

  TemporalSizes sizes_;
  int feature_;
  Convolution first_, second_;
  size_t objects_;
  Perceptron<T> fc_;
  size_t end_;  // of the encoder's tensors
  int n_ = 0;
  Buffer<T> views_, y1_, joined_, dy1_, djoined_, dy2_;
  std::vector<int> hands_;
  // For inference.
  struct Scratch {
    Buffer<T> views, y1, joined, hidden;
    std::vector<int> hands;
  };
  std::vector<Scratch> scratch_;  // a thread's own
  std::vector<T> bias_values_, object_values_;
};

extern template class TemporalNet<float>;
extern template class TemporalNet<double>;

}  // namespace synpo
