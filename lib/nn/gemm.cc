#include "nn/gemm.h"

#include <algorithm>
#include <utility>

#include "nn/lanes.h"

namespace synpo {
namespace {

template <class T>
using Vec = typename Lanes<T>::Vec;

// Tile [kRows, kTileColumns] of C += A panel. Element (i, p) of A is a[i * lda + p], or a[p * lda + i] where it is transposed.
template <class T, int kRows, bool kTransposed>
inline void tile(int depth, const T* a, int lda, const T* panel, T* c, int ldc, int columns, bool accumulate) {
  constexpr int kLanes = Lanes<T>::kCount;
  Vec<T> sum[kRows][2] = {};
  for (int p = 0; p < depth; ++p) {
    const Vec<T> b0 = load<Vec<T>>(panel + size_t(p) * 2 * kLanes), b1 = load<Vec<T>>(panel + size_t(p) * 2 * kLanes + kLanes);
#pragma GCC unroll 16
    for (int i = 0; i < kRows; ++i) {
      const T factor = kTransposed ? a[size_t(p) * lda + i] : a[size_t(i) * lda + p];
      sum[i][0] += factor * b0;
      sum[i][1] += factor * b1;
    }
  }
  if (columns == 2 * kLanes) {
    for (int i = 0; i < kRows; ++i)
      for (int half = 0; half < 2; ++half) {
        T* to = c + size_t(i) * ldc + half * kLanes;
        store(to, accumulate ? Vec<T>(load<Vec<T>>(to) + sum[i][half]) : sum[i][half]);
      }
  } else {
    for (int i = 0; i < kRows; ++i)
      for (int j = 0; j < columns; ++j) {
        T& to = c[size_t(i) * ldc + j];
        to = (accumulate ? to : T(0)) + sum[i][j / kLanes][j % kLanes];
      }
  }
}

template <class T>
using TileFunction = void (*)(int, const T*, int, const T*, T*, int, int, bool);

template <class T, bool kTransposed, int... kRows>
TileFunction<T> pick_tile(int rows, std::integer_sequence<int, kRows...>) {
  static constexpr TileFunction<T> table[] = {tile<T, kRows + 1, kTransposed>...};
  return table[rows - 1];
}

}  // namespace

template <class T>
const T* Packed<T>::panel(int block, int panel) const {
  const size_t rows = std::min(kDepth, k_ - block * kDepth);
  return values_.data() + (size_t(block) * kDepth * panels() + panel * rows) * kTileColumns;
}

template <class T>
void Packed<T>::pack(Op op, int k, int n, const T* b, int ldb) {
  k_ = k;
  n_ = n;
  values_.grow(size_t(k) * panels() * kTileColumns);
  for (int begin = 0; begin < k; begin += kDepth) {
    const int rows = std::min(kDepth, k - begin);
    for (int p = 0; p < panels(); ++p) {
      T* to = const_cast<T*>(panel(begin / kDepth, p));
      const int first = p * kTileColumns, columns = std::min(kTileColumns, n - first);
      if (op == Op::kAsIs) {
        for (int r = 0; r < rows; ++r, to += kTileColumns) {
          const T* from = b + size_t(begin + r) * ldb + first;
          if (columns == kTileColumns) {
            store(to, load<Vec<T>>(from));
            store(to + Lanes<T>::kCount, load<Vec<T>>(from + Lanes<T>::kCount));
          } else {
            std::copy_n(from, columns, to);
            std::fill(to + columns, to + kTileColumns, T(0));
          }
        }
      } else {
        for (int r = 0; r < rows; ++r)
          for (int c = 0; c < kTileColumns; ++c) *to++ = c < columns ? b[size_t(first + c) * ldb + begin + r] : T(0);
      }
    }
  }
}

template <class T>
void gemm(Op op_a, int m, const T* a, int lda, const Packed<T>& b, T* c, int ldc, bool accumulate) {
  constexpr int kRows = Packed<T>::kTileRows, kColumns = Packed<T>::kTileColumns, kDepth = Packed<T>::kDepth;
  const bool transposed = op_a == Op::kTransposed;
  for (int begin = 0; begin < b.k(); begin += kDepth) {
    const int depth = std::min(kDepth, b.k() - begin);
    const T* block = transposed ? a + size_t(begin) * lda : a + begin;
    for (int p = 0; p < b.panels(); ++p) {
      const T* panel = b.panel(begin / kDepth, p);
      const int columns = std::min(kColumns, b.n() - p * kColumns);
      for (int i = 0; i < m; i += kRows) {
        const int rows = std::min(kRows, m - i);
        const auto tiles = std::make_integer_sequence<int, kRows>{};
        const TileFunction<T> run = transposed ? pick_tile<T, true>(rows, tiles) : pick_tile<T, false>(rows, tiles);
        run(depth, transposed ? block + i : block + size_t(i) * lda, lda, panel, c + size_t(i) * ldc + size_t(p) * kColumns, ldc, columns,
            accumulate || begin > 0);
      }
    }
  }
  if (b.k() == 0 && !accumulate)
    for (int i = 0; i < m; ++i) std::fill_n(c + size_t(i) * ldc, b.n(), T(0));
}

template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc, bool accumulate) {
  thread_local Packed<T> packed;  // memory to pack into; nothing of it outlives the call
  packed.pack(op_b, k, n, b, ldb);
  gemm(op_a, m, a, lda, packed, c, ldc, accumulate);
}

#define SYNPO_INSTANTIATE(T)                                                                                                    \
  template class Packed<T>;                                                                                                     \
  template void gemm(Op, int, const T*, int, const Packed<T>&, T*, int, bool);                                                  \
  template void gemm(Op, Op, int, int, int, const T*, int, const T*, int, T*, int, bool);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
