// The inner loops of training and inference, once for every kind of processor, chosen when the program starts.
//
// Everything in this module but kernels.h and select.cc is compiled several times, each time for another target
// (target.cc), and works on plain arrays: no memory is taken here and no threads are started. T is float or double;
// pictures are NHWC.
//
// Targets: `plain` runs everywhere; on x86-64 there are also avx2 (with FMA), avx512, bf16 and amx. The last takes
// float products in pairs of bf16 (product_amx.h): about 16 bits of every factor count instead of 24. bf16 rounds every
// factor to bf16, 8 bits (product_bf16.h), and is used where it is asked for only. All others compute in T throughout,
// avx2 and avx512 to the same bits.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace synpo {

enum class Op { kAsIs, kTransposed };

// Rows of the right matrix of a product that are packed together: rows from a multiple of it on are packed as if they
// were alone, and lie at the offset packed_size() of the rows before them.
constexpr int kPackedRows = 256;

// A tensor of a 3-tap convolution's transformed form (bilinear.h): [products, rows, channels], `stride` rows from
// product to product. A row is one tile of one sample's picture [side, side, channels].
struct TileShape {
  int side, channels, samples;
  size_t stride;
};

template <class T>
struct Transform {
  void (*inputs)(TileShape, const T* x, T* inputs);
  void (*inputs_adjoint)(TileShape, const T* dinputs, T* dx);  // dx +=
  void (*outputs)(TileShape, const T* outputs, T* y);
  void (*outputs_adjoint)(TileShape, const T* dy, T* doutputs);
};

// One step of Adam, on count values: g = gradient + decay * parameter, m and v its moments,
// parameter -= rate * m / (sqrt(v) * correction + epsilon); average (may be null) = keep * average + (1 - keep) *
// parameter.
template <class T>
struct AdamFactors {
  T beta1, beta2, decay, rate, correction, epsilon, keep;
};

// The same of RMSProp: g = scale * gradient + decay * parameter, v the mean of its squares, parameter -= rate * g /
// (sqrt(v) + epsilon).
template <class T>
struct RmsPropFactors {
  T scale, decay, smoothing, rate, epsilon;
};

template <class T>
struct Kernels {
  // The matrix product. pack() takes op(b) [k, n] into packed_size(k, n) values, in an order that is the target's own;
  // multiply() makes c [m, n] = op(a) b, or += where `accumulate`. A row's bits depend on nothing but that row of
  // op(a), and b.
  size_t (*packed_size)(int k, int n);
  void (*pack)(Op op, int k, int n, const T* b, int ldb, T* packed);
  void (*multiply)(Op op, int m, int n, int k, const T* a, int lda, const T* packed, T* c, int ldc, bool accumulate);
  double product_error;  // bound of the relative error of a product of two values, before it is added up in T

  Transform<T> winograd43, toeplitz2;

  // to = sum over terms of factor[i] * from[i], element by element, or += where `accumulate`.
  void (*combine)(int terms, const T* const* from, const T* factor, size_t count, T* to, bool accumulate);

  // Batch normalisation over rows of [rows, channels] (nn/norm.h).
  // sum and squares [channels] +=, of z - shift.
  void (*add_moments)(size_t rows, int channels, const T* z, const T* shift, double* sum, double* squares);
  // y = relu(z * scale + offset).
  void (*norm_relu)(size_t rows, int channels, const T* z, const T* scale, const T* offset, T* y);
  // y = relu(z * scale + offset + other), `other` itself scaled and offset where other_scale is given.
  void (*norm_add_relu)(size_t rows, int channels, const T* z, const T* scale, const T* offset, const T* other,
                        const T* other_scale, const T* other_offset, T* y);
  // d = 0 where y is not positive.
  void (*relu_mask)(size_t count, T* d, const T* y);
  // sum += d, products += d * (z - mean), per channel.
  void (*add_products)(size_t rows, int channels, const T* d, const T* z, const T* mean, double* sum, double* products);
  // The same where d counts as 0 unless z * scale + offset is positive: backward through norm_relu, whose output need
  // not be kept.
  void (*add_masked_products)(size_t rows, int channels, const T* d, const T* z, const T* mean, const T* scale,
                              const T* offset, double* sum, double* products);
  // dz = d * from_d + z * from_z + constant; masked as above where scale is given.
  void (*norm_backward)(size_t rows, int channels, const T* d, const T* z, const T* from_d, const T* from_z,
                        const T* constant, const T* scale, const T* offset, T* dz);

  // y += bias for every row, then relu where asked; bias may be null.
  void (*add_bias)(int rows, int columns, const T* bias, bool relu, T* y);
  T (*dot)(int n, const T* a, const T* b);
  void (*adam)(size_t count, const AdamFactors<T>& factors, const T* gradient, T* parameter, T* m, T* v, T* average);
  void (*rmsprop)(size_t count, const RmsPropFactors<T>& factors, const T* gradient, T* parameter, T* v);
  double (*sum_of_squares)(size_t count, const T* values);  // taken in double
};

// The best kernels that this processor runs, or those of the target named by the environment variable SYNPO_KERNELS;
// one that is unknown or can't run here is a usage error.
template <class T>
const Kernels<T>& kernels();
std::string kernel_target();
// Takes another target from here on; not while kernels run, nor between packing and multiplying.
void choose_kernels(const std::string& target);

// All that run here, from plain to best, for tests and measurements.
template <class T>
struct NamedKernels {
  std::string name;
  const Kernels<T>* kernels;
};
template <class T>
std::vector<NamedKernels<T>> all_kernels();

}  // namespace synpo
