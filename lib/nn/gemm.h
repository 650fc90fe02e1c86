// Matrix products. Matrices are row-major.
#pragma once
#include "base/parallel.h"
#include "kernel/kernels.h"
#include "nn/buffer.h"

namespace synpo {

// The right matrix of a product, laid out as the kernels read it. Packing weights once per update and using them for
// all samples is what this is for.
template <class T>
class Packed {
 public:
  // Takes op(b) [k, n]; ldb is the distance between rows as they lie in memory.
  void pack(Op op, int k, int n, const T* b, int ldb);
  // The same on all threads, which large matrices are worth.
  void pack(Parallel& parallel, Op op, int k, int n, const T* b, int ldb);
  int k() const { return k_; }
  int n() const { return n_; }
  const T* data() const { return values_.data(); }

 private:
  int k_ = 0, n_ = 0;
  Buffer<T> values_;
};

// C [m, n] = op(A) B, or += where `accumulate`, with op(A) [m, b.k()]. One thread; a row's bits depend on nothing but
// that row of op(A), and B.
template <class T>
void gemm(Op op_a, int m, const T* a, int lda, const Packed<T>& b, T* c, int ldc, bool accumulate = false);

// The same for op(B) [k, n] that is used once.
template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc,
          bool accumulate = false);

}  // namespace synpo
