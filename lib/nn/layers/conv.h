// Convolutions on small square pictures in NHWC order, as matrix products over pixels.
//
// The forms of kernel/bilinear.h write a convolution as several products of a transformed picture with a transformed
// weight; every other convolution is one product with gathered pixels. In both cases: inputs [products, rows, depth]
// from x, outputs [products, rows, out] = inputs factors, y from outputs; the gradients use the adjoint of each of
// these maps.
#pragma once
#include <vector>

#include "base/parallel.h"
#include "kernel/kernels.h"
#include "nn/buffer.h"
#include "nn/gemm.h"

namespace synpo {

// Correlation without bias: kernel 3 with padding 1, or kernel 1 without. x is [n, side, side, in], y [n, side_out,
// side_out, out], the weight [kernel, kernel, in, out].
template <class T>
class Conv {
 public:
  enum class Method { kFastest, kDirect };  // kDirect: gathered pixels and one product; the oracle of the faster forms
  Conv(int side, int in, int out, int kernel, int stride, Method method = Method::kFastest);

  int side_out() const { return side_out_; }
  int in() const { return in_; }
  int out() const { return out_; }
  size_t x_size() const { return size_t(side_) * side_ * in_; }  // of one sample
  size_t y_size() const { return size_t(side_out_) * side_out_ * out_; }
  size_t weight_size() const { return size_t(kernel_) * kernel_ * in_ * out_; }
  // Multiply-adds that one sample's forward pass executes in matrix products.
  size_t multiply_adds() const { return size_t(products_) * rows_ * depth_ * out_; }

  // Takes product p of the weight over, p < products(); all are due after every change of it, from any threads. Without
  // `training`, for forward() alone.
  int products() const { return products_; }
  void prepare(int p, const T* weight, bool training);

  // Samples that forward() takes at once: transformed, they fit the second-level cache, and each weight that comes from
  // further away serves as many rows as may be.
  int unit() const { return side_out_ > 4 ? 16 : side_out_ > 2 ? 32 : 64; }
  // One thread. `scratch` belongs to the thread.
  void forward(int samples, const T* x, T* y, Buffer<T>& scratch) const;

  // Backward, in three parts. The batch is taken in slabs of at most kSlab samples, so that memory does not grow with
  // it. First, parts of a slab, a unit() each but the last, on any threads: dx (may be null) = or, where add_dx, += the
  // input's gradient; what the weight's gradient needs is kept in the slab: the parts' own gradients of the transformed
  // weight where those are small, else inputs and outputs.
  static constexpr int kSlab = 512;
  struct Slab {
    Buffer<T> inputs, outputs, gradients, dinputs;
    size_t rows = 0;                // from one product to the next
    std::vector<Packed<T>> packed;  // outputs of each product, for stages
  };
  void reserve(Slab& slab, int samples) const;
  void backward(Slab& slab, Range part, const T* x, const T* dy, T* dx, bool add_dx, Buffer<T>& scratch) const;
  // Then, when all parts of the slab are done, the gradient of the transformed weight: dfactors [dfactors_size()] = or
  // +=, in shards, of fewer rows where `staged`. Before them what several shards multiply with is packed once, in
  // shards of its own, which may be none.
  int pack_shards(bool staged) const {
    return !keeps_gradients() && (staged || depth_ > gradient_rows_) ? products_ : 0;
  }
  void pack_outputs(int p, Slab& slab, int samples) const;
  int gradient_shards(bool staged) const { return products_ * shard_count(depth_, shard_rows(staged)); }
  void weight_gradient(int shard, bool staged, const Slab& slab, int samples, bool accumulate, T* dfactors) const;
  size_t dfactors_size() const { return size_t(products_) * depth_ * out_; }
  // At last, where the form is a transformed one, tap by tap: dweight = the weight's gradient. Otherwise dfactors is
  // that.
  bool transformed() const { return form_ == Form::kWinograd || form_ == Form::kToeplitz; }
  static constexpr int kTaps = 9;
  void finish_gradient(int tap, const T* dfactors, T* dweight) const;

  // The same in stages, for more threads than there are parts of unit() samples: every stage is done in shards of its
  // own, the next one when all of them are done. They come to the bits of forward() and backward(). Inputs and operands
  // are made of a part's own x and dy; elsewhere x, y and dx are all `samples` of a batch or a slab.
  void reserve_stages(Slab& slab, int samples, bool backward) const;
  int product_shards(int samples) const { return products_ * shard_count(samples * rows_, kStageRows); }
  // Forward: inputs, products, outputs.
  void stage_inputs(Slab& slab, Range part, const T* x) const;
  void stage_product(int shard, Slab& slab, int samples, const T* x, T* y) const;
  void stage_outputs(const Slab& slab, Range part, T* y) const;
  // Backward: operands; then gradients of parts (as many shards as there are, which may be none) and, where dx is
  // wanted, products of the gradient; at last dx. weight_gradient() comes after the gradients of parts.
  void stage_operands(Slab& slab, Range part, const T* x, const T* dy) const;
  int part_gradient_shards(int samples) const {
    return keeps_gradients() ? products_ * shard_count(samples, unit()) : 0;
  }
  void stage_part_gradient(int shard, Slab& slab, int samples) const;
  void stage_dproduct(int shard, Slab& slab, int samples) const;
  void stage_dx(const Slab& slab, Range part, T* dx, bool add_dx) const;

 private:
  enum class Form { kPlain, kGathered, kWinograd, kToeplitz };
  static constexpr int kFineRows = 32;   // of the weight's gradient, in a shard of a stage
  static constexpr int kStageRows = 64;  // of a product, in a shard of a stage
  // Samples of a part as the products have them, `rows` from one product to the next.
  void make_inputs(int samples, const T* x, T* inputs, size_t rows) const;
  void add_part_gradients(const Slab& slab, int samples, size_t at, size_t count, bool accumulate, T* to) const;
  void make_dx(int samples, const T* dinputs, size_t rows, T* dx, bool add_dx) const;
  // Values of a row of taps that lie outside the picture before those inside, and the place of these in x.
  struct TapRow {
    size_t before, inside, at;
  };
  template <class Body>
  void for_tap_rows(Body&& body) const;
  void gather_pixels(int samples, const T* x, T* inputs) const;
  void gather_pixels_adjoint(int samples, const T* dinputs, T* dx) const;
  const Transform<T>& transform() const;
  // Inputs and outputs of a part's products, `rows` from one product to the next: in the slab where it keeps them, else
  // in `own`, or x and dy themselves where they will do.
  struct Operands {
    const T *inputs, *outputs;
    size_t rows;
  };
  Operands operands(Slab& slab, Range part, const T* x, const T* dy, T* own) const;
  // Whether a part's gradient of the transformed weight is so much smaller than inputs and outputs that it is kept in
  // their place.
  bool keeps_gradients() const { return 2 * dfactors_size() <= size_t(unit()) * rows_ * products_ * (depth_ + out_); }
  // Rows of the transformed weight's gradient in a shard.
  int shard_rows(bool staged) const { return staged ? kFineRows : gradient_rows_; }
  // Rows from one product to the next in a part of its own: one more than there are, since planes that lie a power of
  // two apart share few places of the first-level cache, which all of them go through tile by tile.
  size_t plane_rows(int samples) const { return size_t(samples) * rows_ + (transformed() ? 1 : 0); }
  TileShape tiles(int channels, int samples, size_t rows) const { return {side_, channels, samples, rows}; }

  int side_, in_, out_, kernel_, stride_, side_out_;
  Form form_;
  int products_;                               // matrix products of the form
  int rows_;                                   // of each product, for one sample
  int depth_;                                  // inner extent of each product
  int gradient_rows_;                          // rows of the weight's gradient in a shard
  std::vector<T> taps_;                        // what a product's weight takes of each tap, [products, taps]
  std::vector<Packed<T>> forward_, backward_;  // a product's weight each, and transposed
};

extern template class Conv<float>;
extern template class Conv<double>;

}  // namespace synpo
