#include "nn/layers/conv.h"

#include <algorithm>
#include <cstring>

#include "kernel/bilinear.h"

namespace synpo {
namespace {

// How much product p takes of each of the 3 x 3 taps: Weight along rows times Weight along columns.
template <class A, class T>
std::vector<T> taps_of_products() {
  std::vector<T> taps;
  for (int row = 0; row < A::kProducts; ++row)
    for (int column = 0; column < A::kProducts; ++column)
      for (int tap = 0; tap < 9; ++tap) taps.push_back(T(A::kWeight.at[row][tap / 3] * A::kWeight.at[column][tap % 3]));
  return taps;
}

// The terms that are not zero, for Kernels::combine.
template <class T>
struct Terms {
  std::vector<const T*> from;
  std::vector<T> factor;
  void add(T by, const T* values) {
    if (by == 0) return;
    from.push_back(values);
    factor.push_back(by);
  }
  void combine(size_t count, T* to, bool accumulate = false) const {
    kernels<T>().combine(int(from.size()), from.data(), factor.data(), count, to, accumulate);
  }
};

}  // namespace

template <class T>
Conv<T>::Conv(int side, int in, int out, int kernel, int stride, Method method)
    : side_(side), in_(in), out_(out), kernel_(kernel), stride_(stride), side_out_((side + stride - 1) / stride) {
  const bool fast = method == Method::kFastest && kernel == 3 && stride == 1;
  form_ = kernel == 1 && stride == 1             ? Form::kPlain
          : fast && side == Toeplitz2::kOut      ? Form::kToeplitz
          : fast && side % Winograd43::kOut == 0 ? Form::kWinograd
                                                 : Form::kGathered;
  const int tile = form_ == Form::kWinograd ? Winograd43::kOut : form_ == Form::kToeplitz ? Toeplitz2::kOut : 1;
  if (form_ == Form::kWinograd) taps_ = taps_of_products<Winograd43, T>();
  if (form_ == Form::kToeplitz) taps_ = taps_of_products<Toeplitz2, T>();
  products_ = transformed() ? int(taps_.size()) / kTaps : 1;
  rows_ = (side_out_ / tile) * (side_out_ / tile);
  depth_ = transformed() ? in : kernel * kernel * in;
  gradient_rows_ = products_ == 1 ? 64 : std::min(depth_, 128);
  forward_.resize(products_);
  backward_.resize(products_);
}

template <class T>
const Transform<T>& Conv<T>::transform() const {
  return form_ == Form::kWinograd ? kernels<T>().winograd43 : kernels<T>().toeplitz2;
}

template <class T>
void Conv<T>::prepare(int p, const T* weight, bool training) {
  if (transformed()) {
    thread_local Buffer<T> factors;  // nothing of it outlives the call
    const size_t plane = size_t(in_) * out_;
    Terms<T> terms;
    for (int tap = 0; tap < kTaps; ++tap) terms.add(taps_[p * kTaps + tap], weight + tap * plane);
    terms.combine(plane, factors.grow(plane));
    weight = factors.data();
  }
  forward_[p].pack(Op::kAsIs, depth_, out_, weight, out_);
  if (training) backward_[p].pack(Op::kTransposed, out_, depth_, weight, out_);
}

// Calls body(run) for every row of taps of every output pixel of one sample, in the order of the gathered rows. Pixels
// next to each other lie next to each other in x: those inside the picture are taken at once.
template <class T>
template <class Body>
void Conv<T>::for_tap_rows(Body&& body) const {
  const int padding = kernel_ / 2;
  for (int row = -padding; row < side_out_ * stride_ - padding; row += stride_)
    for (int column = -padding; column < side_out_ * stride_ - padding; column += stride_)
      for (int r = row; r < row + kernel_; ++r) {
        const bool inside = unsigned(r) < unsigned(side_);
        const int begin = std::max(column, 0), end = inside ? std::min(column + kernel_, side_) : begin;
        body(TapRow{size_t(begin - column) * in_, size_t(end - begin) * in_,
                    (size_t(inside ? r : 0) * side_ + begin) * in_});
      }
}

template <class T>
void Conv<T>::gather_pixels(int samples, const T* x, T* inputs) const {
  const size_t row = size_t(kernel_) * in_;
  for (int n = 0; n < samples; ++n, x += x_size())
    for_tap_rows([&](const TapRow& run) {
      if (run.inside < row) std::memset(inputs, 0, row * sizeof(T));
      std::memcpy(inputs + run.before, x + run.at, run.inside * sizeof(T));
      inputs += row;
    });
}

template <class T>
void Conv<T>::gather_pixels_adjoint(int samples, const T* dinputs, T* dx) const {
  for (int n = 0; n < samples; ++n, dx += x_size())
    for_tap_rows([&](const TapRow& run) {
      const T* from = dinputs + run.before;
      T* to = dx + run.at;
      for (size_t i = 0; i < run.inside; ++i) to[i] += from[i];
      dinputs += size_t(kernel_) * in_;
    });
}

template <class T>
void Conv<T>::make_inputs(int samples, const T* x, T* inputs, size_t rows) const {
  if (transformed())
    transform().inputs(tiles(in_, samples, rows), x, inputs);
  else
    gather_pixels(samples, x, inputs);
}

template <class T>
void Conv<T>::make_dx(int samples, const T* dinputs, size_t rows, T* dx, bool add_dx) const {
  if (!add_dx) std::fill_n(dx, samples * x_size(), T(0));
  if (transformed())
    transform().inputs_adjoint(tiles(in_, samples, rows), dinputs, dx);
  else
    gather_pixels_adjoint(samples, dinputs, dx);
}

template <class T>
void Conv<T>::forward(int samples, const T* x, T* y, Buffer<T>& scratch) const {
  if (form_ == Form::kPlain) return gemm(Op::kAsIs, samples * rows_, x, depth_, forward_[0], y, out_);
  for (; samples > unit(); samples -= unit(), x += unit() * x_size(), y += unit() * y_size())
    forward(unit(), x, y, scratch);
  const int rows = samples * rows_;
  const size_t stride = plane_rows(samples), inputs_size = products_ * stride * depth_;
  T* inputs = scratch.grow(inputs_size + (transformed() ? products_ * stride * out_ : 0));
  T* outputs = transformed() ? inputs + inputs_size : y;
  make_inputs(samples, x, inputs, stride);
  for (int p = 0; p < products_; ++p)
    gemm(Op::kAsIs, rows, inputs + p * stride * depth_, depth_, forward_[p], outputs + p * stride * out_, out_);
  if (transformed()) transform().outputs(tiles(out_, samples, stride), outputs, y);
}

template <class T>
void Conv<T>::reserve(Slab& slab, int samples) const {
  if (keeps_gradients()) {
    slab.gradients.grow(shard_count(samples, unit()) * dfactors_size());
  } else {
    slab.rows = size_t(samples) * rows_;
    slab.inputs.grow(products_ * slab.rows * depth_);
    slab.outputs.grow(products_ * slab.rows * out_);
    if (pack_shards(false) > 0) slab.packed.resize(std::max(slab.packed.size(), size_t(products_)));
  }
}

template <class T>
auto Conv<T>::operands(Slab& slab, Range part, const T* x, const T* dy, T* own) const -> Operands {
  const int samples = part.size();
  const size_t first = size_t(part.begin) * rows_, rows = keeps_gradients() ? plane_rows(samples) : slab.rows;
  T* inputs = keeps_gradients() ? own : slab.inputs.data() + first * depth_;
  T* outputs = keeps_gradients() ? own + products_ * rows * depth_ : slab.outputs.data() + first * out_;
  if (transformed()) {
    transform().inputs(tiles(in_, samples, rows), x, inputs);
    transform().outputs_adjoint(tiles(out_, samples, rows), dy, outputs);
    return {inputs, outputs, rows};
  }
  if (keeps_gradients() && form_ == Form::kPlain) return {x, dy, rows};
  gather_pixels(samples, x, inputs);
  if (keeps_gradients()) return {inputs, dy, rows};
  std::copy_n(dy, samples * y_size(), outputs);
  return {inputs, outputs, rows};
}

template <class T>
void Conv<T>::backward(Slab& slab, Range part, const T* x, const T* dy, T* dx, bool add_dx, Buffer<T>& scratch) const {
  const int samples = part.size(), rows = samples * rows_;
  const size_t plane = plane_rows(samples), inputs_size = products_ * plane * depth_,
               outputs_size = products_ * plane * out_;
  T* dinputs = scratch.grow(inputs_size + (keeps_gradients() ? inputs_size + outputs_size : 0));
  const auto [inputs, outputs, stride] = operands(slab, part, x, dy, dinputs + inputs_size);
  if (keeps_gradients()) {
    T* gradients = slab.gradients.data() + part.begin / unit() * dfactors_size();
    for (int p = 0; p < products_; ++p)
      gemm(Op::kTransposed, Op::kAsIs, depth_, out_, rows, inputs + p * stride * depth_, depth_,
           outputs + p * stride * out_, out_, gradients + size_t(p) * depth_ * out_, out_);
  }
  if (!dx) return;
  if (form_ == Form::kPlain) return gemm(Op::kAsIs, rows, outputs, out_, backward_[0], dx, depth_, add_dx);
  for (int p = 0; p < products_; ++p)
    gemm(Op::kAsIs, rows, outputs + p * stride * out_, out_, backward_[p], dinputs + p * plane * depth_, depth_);
  make_dx(samples, dinputs, plane, dx, add_dx);
}

// The sum of what the parts of a slab have of a gradient, from value `at` on.
template <class T>
void Conv<T>::add_part_gradients(const Slab& slab, int samples, size_t at, size_t count, bool accumulate, T* to) const {
  Terms<T> parts;
  for (int part = 0; part < shard_count(samples, unit()); ++part)
    parts.add(1, slab.gradients.data() + part * dfactors_size() + at);
  parts.combine(count, to, accumulate);
}

template <class T>
void Conv<T>::pack_outputs(int p, Slab& slab, int samples) const {
  slab.packed[size_t(p)].pack(Op::kAsIs, samples * rows_, out_, slab.outputs.data() + p * slab.rows * out_, out_);
}

template <class T>
void Conv<T>::weight_gradient(int shard, bool staged, const Slab& slab, int samples, bool accumulate,
                              T* dfactors) const {
  const int blocks = shard_count(depth_, shard_rows(staged)), p = shard / blocks;
  const Range range = shard_range(depth_, shard_rows(staged), shard % blocks);
  const size_t at = (size_t(p) * depth_ + range.begin) * out_;
  if (keeps_gradients())
    return add_part_gradients(slab, samples, at, size_t(range.size()) * out_, accumulate, dfactors + at);
  const T* inputs = slab.inputs.data() + p * slab.rows * depth_ + range.begin;
  if (pack_shards(staged) > 0)
    return gemm(Op::kTransposed, range.size(), inputs, depth_, slab.packed[size_t(p)], dfactors + at, out_, accumulate);
  gemm(Op::kTransposed, Op::kAsIs, range.size(), out_, samples * rows_, inputs, depth_,
       slab.outputs.data() + p * slab.rows * out_, out_, dfactors + at, out_, accumulate);
}

template <class T>
void Conv<T>::finish_gradient(int tap, const T* dfactors, T* dweight) const {
  const size_t plane = size_t(in_) * out_;
  Terms<T> terms;
  for (int p = 0; p < products_; ++p) terms.add(taps_[p * kTaps + tap], dfactors + p * plane);
  terms.combine(plane, dweight + tap * plane);
}

template <class T>
void Conv<T>::reserve_stages(Slab& slab, int samples, bool backward) const {
  slab.rows = size_t(samples) * rows_;
  slab.inputs.grow(products_ * slab.rows * depth_);
  if (backward || transformed()) slab.outputs.grow(products_ * slab.rows * out_);
  if (!backward) return;
  slab.dinputs.grow(products_ * slab.rows * depth_);
  slab.packed.resize(std::max(slab.packed.size(), size_t(products_)));
  if (keeps_gradients()) slab.gradients.grow(shard_count(samples, unit()) * dfactors_size());
}

template <class T>
void Conv<T>::stage_inputs(Slab& slab, Range part, const T* x) const {
  if (form_ == Form::kPlain) return;
  make_inputs(part.size(), x, slab.inputs.data() + size_t(part.begin) * rows_ * depth_, slab.rows);
}

template <class T>
void Conv<T>::stage_product(int shard, Slab& slab, int samples, const T* x, T* y) const {
  const int blocks = shard_count(samples * rows_, kStageRows), p = shard / blocks;
  const Range rows = shard_range(samples * rows_, kStageRows, shard % blocks);
  const size_t first = p * slab.rows + rows.begin;
  const T* inputs = form_ == Form::kPlain ? x : slab.inputs.data();
  T* outputs = transformed() ? slab.outputs.data() : y;
  gemm(Op::kAsIs, rows.size(), inputs + first * depth_, depth_, forward_[p], outputs + first * out_, out_);
}

template <class T>
void Conv<T>::stage_outputs(const Slab& slab, Range part, T* y) const {
  if (transformed())
    transform().outputs(tiles(out_, part.size(), slab.rows), slab.outputs.data() + size_t(part.begin) * rows_ * out_,
                        y + part.begin * y_size());
}

template <class T>
void Conv<T>::stage_operands(Slab& slab, Range part, const T* x, const T* dy) const {
  const size_t first = size_t(part.begin) * rows_;
  T* outputs = slab.outputs.data() + first * out_;
  make_inputs(part.size(), x, slab.inputs.data() + first * depth_, slab.rows);
  if (transformed())
    transform().outputs_adjoint(tiles(out_, part.size(), slab.rows), dy, outputs);
  else
    std::copy_n(dy, part.size() * y_size(), outputs);
}

template <class T>
void Conv<T>::stage_part_gradient(int shard, Slab& slab, int samples) const {
  const int part = shard / products_, p = shard % products_;
  const Range range = shard_range(samples, unit(), part);
  const size_t first = p * slab.rows + size_t(range.begin) * rows_;
  gemm(Op::kTransposed, Op::kAsIs, depth_, out_, range.size() * rows_, slab.inputs.data() + first * depth_, depth_,
       slab.outputs.data() + first * out_, out_,
       slab.gradients.data() + part * dfactors_size() + size_t(p) * depth_ * out_, out_);
}

template <class T>
void Conv<T>::stage_dproduct(int shard, Slab& slab, int samples) const {
  if (form_ == Form::kPlain) return;  // stage_dx() makes and adds it at once
  const int blocks = shard_count(samples * rows_, kStageRows), p = shard / blocks;
  const Range rows = shard_range(samples * rows_, kStageRows, shard % blocks);
  const size_t first = p * slab.rows + rows.begin;
  gemm(Op::kAsIs, rows.size(), slab.outputs.data() + first * out_, out_, backward_[p],
       slab.dinputs.data() + first * depth_, depth_);
}

template <class T>
void Conv<T>::stage_dx(const Slab& slab, Range part, T* dx, bool add_dx) const {
  const size_t first = size_t(part.begin) * rows_;
  dx += part.begin * x_size();
  if (form_ == Form::kPlain)
    gemm(Op::kAsIs, part.size() * rows_, slab.outputs.data() + first * out_, out_, backward_[0], dx, depth_, add_dx);
  else
    make_dx(part.size(), slab.dinputs.data() + first * depth_, slab.rows, dx, add_dx);
}

template class Conv<float>;
template class Conv<double>;

}  // namespace synpo
