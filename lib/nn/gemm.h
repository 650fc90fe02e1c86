// The matrix product that everything in this room stands on. Matrices are row-major.
#pragma once

namespace synpo {

enum class Op { kAsIs, kTransposed };

// C [m, n] = op(A) op(B), or += where `accumulate`. lda, ldb, ldc are the distances between rows as they lie in memory.
// One thread; the same call gives the same bits. T is float or double.
template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc, bool accumulate = false);

}  // namespace synpo
