// The matrix product in vector registers. Part of target.cc. Matrices are row-major.
//
// C is computed in tiles of kTileRows x kTileColumns that stay in registers while the inner index runs. The right
// matrix is packed: cut into blocks of kDepth rows and panels of kTileColumns columns, zero beyond n, so that the inner
// loop reads it in one line and a panel fits the first-level cache. The left matrix is read where it lies.
#pragma once
#include "kernel/kernels.h"
#include "kernel/lanes.h"

namespace synpo::SYNPO_TARGET {

inline int smaller(int a, int b) { return a < b ? a : b; }

template <class T>
struct Product {
  using V = typename Lanes<T>::Vec;
  static constexpr int kLanes = Lanes<T>::kCount, kTileColumns = 2 * kLanes, kTileRows = kVectorBytes == 64 ? 12 : 6,
                       kDepth = kPackedRows;

  static int panels(int n) { return (n + kTileColumns - 1) / kTileColumns; }
  static size_t packed_size(int k, int n) { return size_t(k) * panels(n) * kTileColumns; }

  static void pack(Op op, int k, int n, const T* b, int ldb, T* to) {
    for (int begin = 0; begin < k; begin += kDepth) {
      const int rows = smaller(kDepth, k - begin);
      for (int first = 0; first < n; first += kTileColumns, to += rows * kTileColumns) {
        const int columns = smaller(kTileColumns, n - first);
        if (op == Op::kAsIs)
          for (int r = 0; r < rows; ++r) copy_row(b + size_t(begin + r) * ldb + first, columns, to + r * kTileColumns);
        else
          for (int c = 0; c < kTileColumns; ++c)
            for (int r = 0; r < rows; ++r)
              to[r * kTileColumns + c] = c < columns ? b[size_t(first + c) * ldb + begin + r] : T(0);
      }
    }
  }

  static void multiply(Op op, int m, int n, int k, const T* a, int lda, const T* packed, T* c, int ldc,
                       bool accumulate) {
    for (int begin = 0; begin < k; begin += kDepth) {
      const int depth = smaller(kDepth, k - begin);
      for (int first = 0; first < n; first += kTileColumns, packed += depth * kTileColumns) {
        const int columns = smaller(kTileColumns, n - first);
        for (int i = 0; i < m; i += kTileRows)
          tiles<kTileRows>(op, smaller(kTileRows, m - i), depth,
                           op == Op::kTransposed ? a + size_t(begin) * lda + i : a + size_t(i) * lda + begin, lda,
                           packed, c + size_t(i) * ldc + first, ldc, columns, accumulate || begin > 0);
      }
    }
    for (int i = 0; k == 0 && !accumulate && i < m; ++i)
      for (int j = 0; j < n; ++j) c[size_t(i) * ldc + j] = 0;
  }

 private:
  static void copy_row(const T* from, int columns, T* to) {
    if (columns == kTileColumns) {
      store(to, load<V>(from));
      store(to + kLanes, load<V>(from + kLanes));
    } else {
      for (int c = 0; c < kTileColumns; ++c) to[c] = c < columns ? from[c] : T(0);
    }
  }

  // Picks the tile of `rows` rows, at most kRows.
  template <int kRows>
  static void tiles(Op op, int rows, int depth, const T* a, int lda, const T* panel, T* c, int ldc, int columns,
                    bool accumulate) {
    if constexpr (kRows > 0) {
      if (rows < kRows) return tiles<kRows - 1>(op, rows, depth, a, lda, panel, c, ldc, columns, accumulate);
      if (op == Op::kTransposed)
        tile<kRows, true>(depth, a, lda, panel, c, ldc, columns, accumulate);
      else
        tile<kRows, false>(depth, a, lda, panel, c, ldc, columns, accumulate);
    }
  }

  // Tile [kRows, kTileColumns] of C += A panel. Element (i, p) of A is a[i * lda + p], or a[p * lda + i] where it is
  // transposed.
  template <int kRows, bool kTransposed>
  static void tile(int depth, const T* a, int lda, const T* panel, T* c, int ldc, int columns, bool accumulate) {
    V sum[kRows][2] = {};
    for (int p = 0; p < depth; ++p) {
      const V b0 = load<V>(panel + size_t(p) * kTileColumns), b1 = load<V>(panel + size_t(p) * kTileColumns + kLanes);
#pragma GCC unroll 16
      for (int i = 0; i < kRows; ++i) {
        const T factor = kTransposed ? a[size_t(p) * lda + i] : a[size_t(i) * lda + p];
        sum[i][0] += factor * b0;
        sum[i][1] += factor * b1;
      }
    }
    if (columns == kTileColumns) {
      for (int i = 0; i < kRows; ++i)
        for (int half = 0; half < 2; ++half) {
          T* to = c + size_t(i) * ldc + half * kLanes;
          store(to, accumulate ? V(load<V>(to) + sum[i][half]) : sum[i][half]);
        }
    } else {
      for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < columns; ++j) {
          T& to = c[size_t(i) * ldc + j];
          to = (accumulate ? to : T(0)) + sum[i][j / kLanes][j % kLanes];
        }
    }
  }
};

}  // namespace synpo::SYNPO_TARGET
