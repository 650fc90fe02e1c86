// Convolutions on small square pictures in NHWC order, as matrix products over pixels.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/gemm.h"

namespace synpo {

// Correlation without bias: kernel 3 with padding 1, or kernel 1 without. x is [n, side, side, in], y [n, side_out, side_out, out],
// the weight [kernel, kernel, in, out].
template <class T>
class Conv {
 public:
  enum class Method { kFastest, kDirect };  // kDirect: gathered pixels and one product; the oracle of the faster forms
  Conv(int side, int in, int out, int kernel, int stride, Method method = Method::kFastest);

  int side_out() const { return side_out_; }
  int in() const { return in_; }
  int out() const { return out_; }
  size_t x_size() const { return size_t(side_) * side_ * in_; }            // of one sample
  size_t y_size() const { return size_t(side_out_) * side_out_ * out_; }
  size_t weight_size() const { return size_t(kernel_) * kernel_ * in_ * out_; }
  // Multiply-adds that one sample's forward pass executes in matrix products.
  size_t multiply_adds() const { return size_t(products_) * rows_ * depth_ * out_; }

  // Takes the weight over; to be called after every change of it. Without `training`, for forward() alone.
  void prepare(Parallel& parallel, const T* weight, bool training = true);

  // Samples that are worth passing to forward() at once.
  int unit() const { return side_out_ > 4 ? 16 : 32; }
  // One thread. `scratch` belongs to the thread.
  void forward(int samples, const T* x, T* y, Buffer<T>& scratch) const;

  struct Workspace {
    Buffer<T> inputs, outputs, dweight;
    std::vector<Buffer<T>> scratch;  // one a thread
  };
  // dweight += the weight's gradient; dx (may be null) = or, where add_dx, += the input's. All threads.
  void backward(Parallel& parallel, int samples, const T* x, const T* dy, T* dx, bool add_dx, T* dweight, Workspace& work) const;

 private:
  enum class Form { kPlain, kGathered, kWinograd, kToeplitz };
  template <class Algorithm>
  void gather_tiles(int samples, const T* x, T* inputs, size_t product_stride) const;
  template <class Algorithm>
  void scatter_tiles(int samples, const T* outputs, size_t product_stride, T* y) const;
  template <class Algorithm>
  void gather_tiles_adjoint(int samples, const T* dinputs, size_t product_stride, T* dx) const;
  template <class Algorithm>
  void scatter_tiles_adjoint(int samples, const T* dy, T* doutputs, size_t product_stride) const;
  template <class Body>
  void for_taps(Body&& body) const;
  void gather_pixels(int samples, const T* x, T* inputs) const;
  void gather_pixels_adjoint(int samples, const T* dinputs, T* dx) const;

  // inputs [products, rows, depth] from x; y from outputs [products, rows, out]; and their transposes.
  void gather(int samples, const T* x, T* inputs, size_t product_stride) const;
  void scatter(int samples, const T* outputs, size_t product_stride, T* y) const;
  void gather_adjoint(int samples, const T* dinputs, size_t product_stride, T* dx) const;
  void scatter_adjoint(int samples, const T* dy, T* doutputs, size_t product_stride) const;
  bool transformed() const { return form_ == Form::kWinograd || form_ == Form::kToeplitz; }

  int side_, in_, out_, kernel_, stride_, side_out_;
  Form form_;
  int products_;  // matrix products of the form
  int rows_;      // of each product, for one sample
  int depth_;     // inner extent of each product
  Buffer<T> weight_;  // [products, depth, out]
  std::vector<Packed<T>> forward_, backward_;  // the same, a matrix each, and transposed
};

extern template class Conv<float>;
extern template class Conv<double>;

}  // namespace synpo
