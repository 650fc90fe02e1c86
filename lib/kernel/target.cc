// The kernels of one target: compiled once for each, with SYNPO_TARGET its name and the compiler's options for its
// instructions (Makefile).
//
// A linker keeps one copy of an inline function that several objects bring. Code compiled for one processor must
// therefore not leave here under a name that another could use: everything stands in the target's own namespace, and
// nothing with code of its own is included. scripts/check looks at what the objects export.
#include "kernel/elementwise.h"
#include "kernel/kernels.h"
#include "kernel/product.h"
#include "kernel/transform.h"
#ifdef __AMX_BF16__
#include "kernel/product_amx.h"
#endif
#ifdef __AVX512BF16__
#include "kernel/product_bf16.h"
#endif

namespace synpo::SYNPO_TARGET {
namespace {

template <class P, class T>
constexpr void multiply_with(double error, Kernels<T>& k) {
  k.packed_size = P::packed_size;
  k.pack = P::pack;
  k.multiply = P::multiply;
  k.product_error = error;
}

template <class T>
constexpr Kernels<T> table() {
  using R = Rows<T>;
  Kernels<T> k = {};
  multiply_with<Product<T>>(sizeof(T) == sizeof(float) ? 0x1p-24 : 0x1p-53, k);
#ifdef __AMX_BF16__
  if constexpr (sizeof(T) == sizeof(float)) multiply_with<AmxProduct>(0x1p-14, k);
#endif
#ifdef __AVX512BF16__
  if constexpr (sizeof(T) == sizeof(float)) multiply_with<Bf16Product>(0x1p-7 + 0x1p-16, k);  // both are rounded
#endif
  k.winograd43 = Tiles<T, Winograd43>::table();
  k.toeplitz2 = Tiles<T, Toeplitz2>::table();
  k.combine = R::combine;
  k.add_moments = R::add_moments;
  k.norm_relu = R::norm_relu;
  k.norm_add_relu = R::norm_add_relu;
  k.relu_mask = R::relu_mask;
  k.add_products = R::add_products;
  k.add_masked_products = R::add_masked_products;
  k.norm_backward = R::norm_backward;
  k.add_bias = R::add_bias;
  k.dot = R::dot;
  k.adam = R::adam;
  k.rmsprop = R::rmsprop;
  k.sum_of_squares = R::sum_of_squares;
  return k;
}

}  // namespace

extern const Kernels<float> kFloatKernels;
extern const Kernels<double> kDoubleKernels;
constinit const Kernels<float> kFloatKernels = table<float>();
constinit const Kernels<double> kDoubleKernels = table<double>();

}  // namespace synpo::SYNPO_TARGET
