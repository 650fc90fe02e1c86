// The matrix product that everything in this room stands on. Matrices are row-major.
//
// C is computed in tiles of kTileRows x kTileColumns that stay in vector registers while the inner index runs. The right matrix is packed first:
// cut into blocks of kDepth rows and panels of kTileColumns columns, so that the inner loop reads it in one line; a panel fits the first-level
// cache. The left matrix is read where it lies. Packing weights once per update and using them for all samples is what Packed is for.
#pragma once
#include "nn/buffer.h"
#include "nn/lanes.h"

namespace synpo {

enum class Op { kAsIs, kTransposed };

template <class T>
class Packed {
 public:
  static constexpr int kTileColumns = 2 * Lanes<T>::kCount;
  static constexpr int kTileRows = kVectorBytes == 64 ? 12 : 6;
  static constexpr int kDepth = 256;

  // Takes op(b) [k, n]; ldb is the distance between rows as they lie in memory.
  void pack(Op op, int k, int n, const T* b, int ldb);
  int k() const { return k_; }
  int n() const { return n_; }
  // The panel of columns [panel * kTileColumns, ...) in the rows of block `block`: [rows of the block, kTileColumns], zero beyond n.
  const T* panel(int block, int panel) const;
  int panels() const { return (n_ + kTileColumns - 1) / kTileColumns; }

 private:
  int k_ = 0, n_ = 0;
  Buffer<T> values_;
};

// C [m, n] = op(A) B, or += where `accumulate`, with op(A) [m, b.k()]. One thread; a row's bits depend on nothing but that row of op(A), and B.
template <class T>
void gemm(Op op_a, int m, const T* a, int lda, const Packed<T>& b, T* c, int ldc, bool accumulate = false);

// The same for op(B) [k, n] that is used once.
template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc, bool accumulate = false);

}  // namespace synpo
