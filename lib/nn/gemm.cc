#include "nn/gemm.h"

namespace synpo {

template <class T>
void Packed<T>::pack(Op op, int k, int n, const T* b, int ldb) {
  k_ = k;
  n_ = n;
  kernels<T>().pack(op, k, n, b, ldb, values_.grow(kernels<T>().packed_size(k, n)));
}

template <class T>
void Packed<T>::pack(Parallel& parallel, Op op, int k, int n, const T* b, int ldb) {
  constexpr size_t kWorthwhile = 1 << 14;
  if (size_t(k) * n < kWorthwhile) return pack(op, k, n, b, ldb);
  k_ = k;
  n_ = n;
  T* to = values_.grow(kernels<T>().packed_size(k, n));
  parallel.run(shard_count(k, kPackedRows), [&](int shard, int) {
    const Range range = shard_range(k, kPackedRows, shard);
    const T* from = b + (op == Op::kAsIs ? size_t(range.begin) * ldb : size_t(range.begin));
    kernels<T>().pack(op, range.size(), n, from, ldb, to + kernels<T>().packed_size(range.begin, n));
  });
}

template <class T>
void gemm(Op op_a, int m, const T* a, int lda, const Packed<T>& b, T* c, int ldc, bool accumulate) {
  kernels<T>().multiply(op_a, m, b.n(), b.k(), a, lda, b.data(), c, ldc, accumulate);
}

template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc,
          bool accumulate) {
  thread_local Packed<T> packed;  // memory to pack into; nothing of it outlives the call
  packed.pack(op_b, k, n, b, ldb);
  gemm(op_a, m, a, lda, packed, c, ldc, accumulate);
}

#define SYNPO_INSTANTIATE(T)                                                   \
  template class Packed<T>;                                                    \
  template void gemm(Op, int, const T*, int, const Packed<T>&, T*, int, bool); \
  template void gemm(Op, Op, int, int, int, const T*, int, const T*, int, T*, int, bool);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
