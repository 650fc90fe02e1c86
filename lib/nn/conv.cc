#include "nn/conv.h"

#include <algorithm>
#include <cstring>

#include "nn/bilinear.h"
#include "nn/gemm.h"
#include "nn/lanes.h"

namespace synpo {
namespace {

// Transposed maps need names of their own to be template arguments.
template <class A>
constexpr auto kInputT = A::kInput.transposed();
template <class A>
constexpr auto kOutputT = A::kOutput.transposed();
template <class A>
constexpr auto kWeightT = A::kWeight.transposed();

template <class A>
constexpr int kSquare = A::kProducts * A::kProducts;

// Where a tile's first input pixel lies, and which of its inputs are inside the picture.
struct TilePlace {
  int row, column;  // of the first input; may be -1
};

template <class A>
TilePlace tile_place(int tile, int tiles_per_side) {
  return {tile / tiles_per_side * A::kOut - A::kPadding, tile % tiles_per_side * A::kOut - A::kPadding};
}

}  // namespace

template <class T>
Conv<T>::Conv(int side, int in, int out, int kernel, int stride, Method method)
    : side_(side), in_(in), out_(out), kernel_(kernel), stride_(stride), side_out_((side + stride - 1) / stride) {
  const bool fast = method == Method::kFastest && kernel == 3 && stride == 1;
  form_ = kernel == 1 && stride == 1      ? Form::kPlain
          : fast && side == Toeplitz2::kOut ? Form::kToeplitz
          : fast && side % Winograd43::kOut == 0 ? Form::kWinograd
                                          : Form::kGathered;
  if (transformed()) {
    const int tile = form_ == Form::kWinograd ? Winograd43::kOut : Toeplitz2::kOut;
    products_ = form_ == Form::kWinograd ? kSquare<Winograd43> : kSquare<Toeplitz2>;
    rows_ = (side / tile) * (side / tile);
    depth_ = in;
  } else {
    products_ = 1;
    rows_ = side_out_ * side_out_;
    depth_ = kernel * kernel * in;
  }
}

template <class T>
void Conv<T>::prepare(Parallel& parallel, const T* weight, bool training) {
  const size_t plane = size_t(in_) * out_;
  T* to = transformed() ? weight_.grow(size_t(products_) * depth_ * out_) : nullptr;
  const auto transform = [&]<class A>(A) {
    parallel.run(shard_count(in_, 16), [&](int shard, int) {
      const Range range = shard_range(in_, 16, shard);
      for (int i = range.begin; i < range.end; ++i)
        for_lanes<T>(out_, [&](auto tag, int c) {
          using V = decltype(tag);
          const size_t at = size_t(i) * out_ + c;
          V taps[9], factors[kSquare<A>];
          for (int k = 0; k < 9; ++k) taps[k] = load<V>(weight + k * plane + at);
          transform_2d<A::kWeight>(taps, factors);
          for (int p = 0; p < kSquare<A>; ++p) store(to + p * plane + at, factors[p]);
        });
    });
  };
  if (form_ == Form::kWinograd) transform(Winograd43{});
  if (form_ == Form::kToeplitz) transform(Toeplitz2{});
  forward_.resize(products_);
  backward_.resize(products_);
  parallel.run(products_ * (training ? 2 : 1), [&](int shard, int) {
    const int p = shard % products_;
    const T* from = transformed() ? to + size_t(p) * depth_ * out_ : weight;
    if (shard < products_)
      forward_[p].pack(Op::kAsIs, depth_, out_, from, out_);
    else
      backward_[p].pack(Op::kTransposed, out_, depth_, from, out_);
  });
}

template <class T>
template <class A>
void Conv<T>::gather_tiles(int samples, const T* x, T* inputs, size_t product_stride) const {
  const int per_side = side_ / A::kOut;
  for (int row = 0; row < samples * rows_; ++row) {
    const T* picture = x + size_t(row / rows_) * x_size();
    const TilePlace place = tile_place<A>(row % rows_, per_side);
    for_lanes<T>(in_, [&](auto tag, int c) {
      using V = decltype(tag);
      V pixels[A::kIn * A::kIn], factors[kSquare<A>];
      for (int i = 0; i < A::kIn; ++i)
        for (int j = 0; j < A::kIn; ++j) {
          const int r = place.row + i, q = place.column + j;
          const bool inside = A::kPadding == 0 || (unsigned(r) < unsigned(side_) && unsigned(q) < unsigned(side_));
          pixels[i * A::kIn + j] = inside ? load<V>(picture + (size_t(r) * side_ + q) * in_ + c) : V{};
        }
      transform_2d<A::kInput>(pixels, factors);
      for (int p = 0; p < kSquare<A>; ++p) store(inputs + p * product_stride * in_ + size_t(row) * in_ + c, factors[p]);
    });
  }
}

template <class T>
template <class A>
void Conv<T>::scatter_tiles(int samples, const T* outputs, size_t product_stride, T* y) const {
  const int per_side = side_ / A::kOut;
  for (int row = 0; row < samples * rows_; ++row) {
    T* picture = y + size_t(row / rows_) * y_size();
    const int first_row = row % rows_ / per_side * A::kOut, first_column = row % rows_ % per_side * A::kOut;
    for_lanes<T>(out_, [&](auto tag, int c) {
      using V = decltype(tag);
      V factors[kSquare<A>], pixels[A::kOut * A::kOut];
      for (int p = 0; p < kSquare<A>; ++p) factors[p] = load<V>(outputs + p * product_stride * out_ + size_t(row) * out_ + c);
      transform_2d<A::kOutput>(factors, pixels);
      for (int i = 0; i < A::kOut; ++i)
        for (int j = 0; j < A::kOut; ++j)
          store(picture + (size_t(first_row + i) * side_ + first_column + j) * out_ + c, pixels[i * A::kOut + j]);
    });
  }
}

template <class T>
template <class A>
void Conv<T>::gather_tiles_adjoint(int samples, const T* dinputs, size_t product_stride, T* dx) const {
  const int per_side = side_ / A::kOut;
  for (int row = 0; row < samples * rows_; ++row) {
    T* picture = dx + size_t(row / rows_) * x_size();
    const TilePlace place = tile_place<A>(row % rows_, per_side);
    for_lanes<T>(in_, [&](auto tag, int c) {
      using V = decltype(tag);
      V factors[kSquare<A>], pixels[A::kIn * A::kIn];
      for (int p = 0; p < kSquare<A>; ++p) factors[p] = load<V>(dinputs + p * product_stride * in_ + size_t(row) * in_ + c);
      transform_2d<kInputT<A>>(factors, pixels);
      for (int i = 0; i < A::kIn; ++i)
        for (int j = 0; j < A::kIn; ++j) {
          const int r = place.row + i, q = place.column + j;
          if (A::kPadding > 0 && (unsigned(r) >= unsigned(side_) || unsigned(q) >= unsigned(side_))) continue;
          T* at = picture + (size_t(r) * side_ + q) * in_ + c;
          store(at, V(load<V>(at) + pixels[i * A::kIn + j]));
        }
    });
  }
}

template <class T>
template <class A>
void Conv<T>::scatter_tiles_adjoint(int samples, const T* dy, T* doutputs, size_t product_stride) const {
  const int per_side = side_ / A::kOut;
  for (int row = 0; row < samples * rows_; ++row) {
    const T* picture = dy + size_t(row / rows_) * y_size();
    const int first_row = row % rows_ / per_side * A::kOut, first_column = row % rows_ % per_side * A::kOut;
    for_lanes<T>(out_, [&](auto tag, int c) {
      using V = decltype(tag);
      V pixels[A::kOut * A::kOut], factors[kSquare<A>];
      for (int i = 0; i < A::kOut; ++i)
        for (int j = 0; j < A::kOut; ++j)
          pixels[i * A::kOut + j] = load<V>(picture + (size_t(first_row + i) * side_ + first_column + j) * out_ + c);
      transform_2d<kOutputT<A>>(pixels, factors);
      for (int p = 0; p < kSquare<A>; ++p) store(doutputs + p * product_stride * out_ + size_t(row) * out_ + c, factors[p]);
    });
  }
}

// Calls body(at) for every tap of every output pixel of one sample, in the order of the gathered rows; `at` is the place of the tap's
// pixel in x, or -1 outside the picture.
template <class T>
template <class Body>
void Conv<T>::for_taps(Body&& body) const {
  const int padding = kernel_ / 2;
  for (int pixel = 0; pixel < side_out_ * side_out_; ++pixel)
    for (int tap = 0; tap < kernel_ * kernel_; ++tap) {
      const int r = pixel / side_out_ * stride_ + tap / kernel_ - padding, q = pixel % side_out_ * stride_ + tap % kernel_ - padding;
      const bool inside = unsigned(r) < unsigned(side_) && unsigned(q) < unsigned(side_);
      body(inside ? (r * side_ + q) * in_ : -1);
    }
}

template <class T>
void Conv<T>::gather_pixels(int samples, const T* x, T* inputs) const {
  for (int n = 0; n < samples; ++n, x += x_size())
    for_taps([&](int at) {
      if (at >= 0)
        std::memcpy(inputs, x + at, in_ * sizeof(T));
      else
        std::memset(inputs, 0, in_ * sizeof(T));
      inputs += in_;
    });
}

template <class T>
void Conv<T>::gather_pixels_adjoint(int samples, const T* dinputs, T* dx) const {
  for (int n = 0; n < samples; ++n, dx += x_size())
    for_taps([&](int at) {
      for (int c = 0; at >= 0 && c < in_; ++c) dx[at + c] += dinputs[c];
      dinputs += in_;
    });
}

template <class T>
void Conv<T>::gather(int samples, const T* x, T* inputs, size_t product_stride) const {
  if (form_ == Form::kWinograd) return gather_tiles<Winograd43>(samples, x, inputs, product_stride);
  if (form_ == Form::kToeplitz) return gather_tiles<Toeplitz2>(samples, x, inputs, product_stride);
  gather_pixels(samples, x, inputs);
}

template <class T>
void Conv<T>::scatter(int samples, const T* outputs, size_t product_stride, T* y) const {
  if (form_ == Form::kWinograd) return scatter_tiles<Winograd43>(samples, outputs, product_stride, y);
  scatter_tiles<Toeplitz2>(samples, outputs, product_stride, y);
}

template <class T>
void Conv<T>::gather_adjoint(int samples, const T* dinputs, size_t product_stride, T* dx) const {
  if (form_ == Form::kWinograd) return gather_tiles_adjoint<Winograd43>(samples, dinputs, product_stride, dx);
  if (form_ == Form::kToeplitz) return gather_tiles_adjoint<Toeplitz2>(samples, dinputs, product_stride, dx);
  gather_pixels_adjoint(samples, dinputs, dx);
}

template <class T>
void Conv<T>::scatter_adjoint(int samples, const T* dy, T* doutputs, size_t product_stride) const {
  if (form_ == Form::kWinograd) return scatter_tiles_adjoint<Winograd43>(samples, dy, doutputs, product_stride);
  scatter_tiles_adjoint<Toeplitz2>(samples, dy, doutputs, product_stride);
}

template <class T>
void Conv<T>::forward(int samples, const T* x, T* y, Buffer<T>& scratch) const {
  const int rows = samples * rows_;
  if (form_ == Form::kPlain) return gemm(Op::kAsIs, rows, x, depth_, forward_[0], y, out_);
  const size_t inputs_size = size_t(products_) * rows * depth_;
  T* inputs = scratch.grow(inputs_size + (transformed() ? size_t(products_) * rows * out_ : 0));
  T* outputs = transformed() ? inputs + inputs_size : y;
  gather(samples, x, inputs, rows);
  for (int p = 0; p < products_; ++p)
    gemm(Op::kAsIs, rows, inputs + size_t(p) * rows * depth_, depth_, forward_[p], outputs + size_t(p) * rows * out_, out_);
  if (transformed()) scatter(samples, outputs, rows, y);
}

template <class T>
void Conv<T>::backward(Parallel& parallel, int samples, const T* x, const T* dy, T* dx, bool add_dx, T* dweight,
                       Workspace& work) const {
  // The whole batch's transformed pictures would not fit in any cache, and memory should not grow with the batch.
  constexpr int kSlab = 512;
  const size_t slab_rows = size_t(std::min(samples, kSlab)) * rows_;
  const bool plain = form_ == Form::kPlain;
  if (!plain) work.inputs.grow(products_ * slab_rows * depth_);
  if (transformed()) work.outputs.grow(products_ * slab_rows * out_);
  work.scratch.resize(std::max<size_t>(work.scratch.size(), parallel.threads()));
  const size_t plane = size_t(depth_) * out_;
  T* dfactors = transformed() ? work.dweight.grow(products_ * plane) : dweight;
  const int blocks = products_ == 1 ? shard_count(depth_, 48) : depth_ >= 128 ? 2 : 1;
  const int block_size = shard_count(depth_, blocks);

  for (int begin = 0; begin < samples; begin += kSlab) {
    const int size = std::min(kSlab, samples - begin);
    const T* slab_x = x + begin * x_size();
    const T* slab_dy = dy + begin * y_size();
    const T* inputs = plain ? slab_x : work.inputs.data();
    const T* outputs = transformed() ? work.outputs.data() : slab_dy;
    parallel.run(shard_count(size, unit()), [&](int shard, int thread) {
      const Range range = shard_range(size, unit(), shard);
      const size_t first = size_t(range.begin) * rows_;
      const int rows = range.size() * rows_;
      if (!plain)
        gather(range.size(), slab_x + range.begin * x_size(), work.inputs.data() + first * depth_, slab_rows);
      if (transformed())
        scatter_adjoint(range.size(), slab_dy + range.begin * y_size(), work.outputs.data() + first * out_, slab_rows);
      if (!dx) return;
      T* to = dx + (begin + range.begin) * x_size();
      if (plain) return gemm(Op::kAsIs, rows, outputs + first * out_, out_, backward_[0], to, depth_, add_dx);
      T* dinputs = work.scratch[thread].grow(size_t(products_) * rows * depth_);
      for (int p = 0; p < products_; ++p)
        gemm(Op::kAsIs, rows, outputs + (p * slab_rows + first) * out_, out_, backward_[p], dinputs + size_t(p) * rows * depth_, depth_);
      if (!add_dx) std::memset(static_cast<void*>(to), 0, range.size() * x_size() * sizeof(T));
      gather_adjoint(range.size(), dinputs, rows, to);
    });
    parallel.run(products_ * blocks, [&](int shard, int) {
      const int p = shard / blocks;
      const Range range = shard_range(depth_, block_size, shard % blocks);
      if (range.size() <= 0) return;
      gemm(Op::kTransposed, Op::kAsIs, range.size(), out_, size * rows_, inputs + p * slab_rows * depth_ + range.begin, depth_,
           outputs + p * slab_rows * out_, out_, dfactors + p * plane + size_t(range.begin) * out_, out_,
           begin > 0 || !transformed());
    });
  }
  if (!transformed()) return;
  const auto transform = [&]<class A>(A) {
    parallel.run(shard_count(in_, 16), [&](int shard, int) {
      const Range range = shard_range(in_, 16, shard);
      for (int i = range.begin; i < range.end; ++i)
        for_lanes<T>(out_, [&](auto tag, int c) {
          using V = decltype(tag);
          const size_t at = size_t(i) * out_ + c;
          V factors[kSquare<A>], taps[9];
          for (int p = 0; p < kSquare<A>; ++p) factors[p] = load<V>(dfactors + p * plane + at);
          transform_2d<kWeightT<A>>(factors, taps);
          for (int k = 0; k < 9; ++k) store(dweight + k * plane + at, V(load<V>(dweight + k * plane + at) + taps[k]));
        });
    });
  };
  if (form_ == Form::kWinograd)
    transform(Winograd43{});
  else
    transform(Toeplitz2{});
}

template class Conv<float>;
template class Conv<double>;

}  // namespace synpo
