// The matrix product of floats that are rounded to bf16 first (8 significant bits). Part of target.cc.
//
// The instruction multiplies pairs of bf16 and adds them to floats. Pairs are next to each other in the inner index: a
// word holds values 2 q and 2 q + 1 of it. B is packed in blocks and panels as in product.h, a word in place of two
// rows; A is rounded on the way, kRows rows by kDepth at a time, into words [row, q], or [q, row] where it is
// transposed.
#pragma once
#include <immintrin.h>

#include "kernel/kernels.h"
#include "kernel/product.h"

namespace synpo::SYNPO_TARGET {

struct Bf16Product {
  static constexpr int kColumns = 32;   // of a panel
  static constexpr int kTileRows = 12;  // of a tile of C, which is as wide as a panel
  static constexpr int kRows = 48;      // of A at a time
  static constexpr int kDepth = kPackedRows, kPairs = kDepth / 2;
  using Word = unsigned;

  static int words(int k) { return (k + 1) / 2; }
  static int panels(int n) { return (n + kColumns - 1) / kColumns; }
  static size_t packed_size(int k, int n) { return size_t(words(k)) * panels(n) * kColumns; }

  static void pack(Op op, int k, int n, const float* b, int ldb, float* packed) {
    Word* to = reinterpret_cast<Word*>(packed);
    for (int begin = 0; begin < k; begin += kDepth) {
      const int depth = smaller(kDepth, k - begin);
      for (int first = 0; first < n; first += kColumns, to += words(depth) * kColumns) {
        const int columns = smaller(kColumns, n - first);
        if (op == Op::kAsIs) {
          round_rows(b + size_t(begin) * ldb + first, ldb, depth, columns, to, kColumns);
        } else {
          Word row[kPairs];
          for (int c = 0; c < kColumns; ++c) {
            if (c < columns) round_row(b + size_t(first + c) * ldb + begin, depth, row);
            for (int q = 0; q < words(depth); ++q) to[q * kColumns + c] = c < columns ? row[q] : 0;
          }
        }
      }
    }
  }

  static void multiply(Op op, int m, int n, int k, const float* a, int lda, const float* packed, float* c, int ldc,
                       bool accumulate) {
    if (k == 0) return Product<float>::multiply(op, m, n, k, a, lda, packed, c, ldc, accumulate);
    alignas(64) Word left[kRows * kPairs];
    const Word* right = reinterpret_cast<const Word*>(packed);
    for (int begin = 0; begin < k; begin += kDepth) {
      const int depth = smaller(kDepth, k - begin), pairs = words(depth);
      for (int row = 0; row < m; row += kRows) {
        const int rows = smaller(kRows, m - row);
        if (op == Op::kAsIs)
          for (int i = 0; i < rows; ++i) round_row(a + size_t(row + i) * lda + begin, depth, left + i * kPairs);
        else
          round_rows(a + size_t(begin) * lda + row, lda, depth, rows, left, kRows);
        for (int first = 0; first < n; first += kColumns)
          for (int i = 0; i < rows; i += kTileRows) {
            float* to = c + size_t(row + i) * ldc + first;
            const Word* panel = right + size_t(first) * pairs;
            const int tall = smaller(kTileRows, rows - i), wide = smaller(kColumns, n - first);
            if (op == Op::kAsIs)
              tiles<kTileRows, kPairs, 1>(tall, pairs, left + i * kPairs, panel, to, ldc, wide,
                                          accumulate || begin > 0);
            else
              tiles<kTileRows, 1, kRows>(tall, pairs, left + i, panel, to, ldc, wide, accumulate || begin > 0);
          }
      }
      right += size_t(pairs) * panels(n) * kColumns;
    }
  }

 private:
  // Picks the tile of `rows` rows, at most kMost. Word q of row i of A is a[i * kRow + q * kPair].
  template <int kMost, int kRow, int kPair>
  static void tiles(int rows, int pairs, const Word* a, const Word* panel, float* c, int ldc, int columns,
                    bool accumulate) {
    if constexpr (kMost > 0) {
      if (rows < kMost) return tiles<kMost - 1, kRow, kPair>(rows, pairs, a, panel, c, ldc, columns, accumulate);
      tile<kMost, kRow, kPair>(pairs, a, panel, c, ldc, columns, accumulate);
    }
  }

  template <int kHeight, int kRow, int kPair>
  static void tile(int pairs, const Word* a, const Word* panel, float* c, int ldc, int columns, bool accumulate) {
    __m512 sum[kHeight][2] = {};
    for (int q = 0; q < pairs; ++q, panel += kColumns) {
      const __m512bh b0 = (__m512bh)_mm512_loadu_si512(panel), b1 = (__m512bh)_mm512_loadu_si512(panel + 16);
#pragma GCC unroll 16
      for (int i = 0; i < kHeight; ++i) {
        const __m512bh factor = (__m512bh)_mm512_set1_epi32(int(a[i * kRow + q * kPair]));
        sum[i][0] = _mm512_dpbf16_ps(sum[i][0], factor, b0);
        sum[i][1] = _mm512_dpbf16_ps(sum[i][1], factor, b1);
      }
    }
    for (int i = 0; i < kHeight; ++i)
      for (int half = 0; half < 2; ++half) {
        const int count = columns - 16 * half;
        if (count <= 0) continue;
        const __mmask16 mask = count >= 16 ? 0xffff : __mmask16((1u << count) - 1);
        float* to = c + size_t(i) * ldc + 16 * half;
        const __m512 before = accumulate ? _mm512_maskz_loadu_ps(mask, to) : _mm512_setzero_ps();
        _mm512_mask_storeu_ps(to, mask, _mm512_add_ps(before, sum[i][half]));
      }
  }

  // The words of a row of `count` values.
  static void round_row(const float* from, int count, Word* to) {
    for (int p = 0; p < count; p += 32, to += 16) {
      const int left = count - p;
      const __mmask16 low = left >= 16 ? 0xffff : __mmask16((1u << left) - 1),
                      high = left >= 32  ? 0xffff
                             : left > 16 ? __mmask16((1u << (left - 16)) - 1)
                                         : 0,
                      words = left >= 32 ? 0xffff : __mmask16((1u << ((left + 1) / 2)) - 1);
      const __m512i both = (__m512i)_mm512_cvtne2ps_pbh(_mm512_maskz_loadu_ps(high, from + p + 16),
                                                        _mm512_maskz_loadu_ps(low, from + p));
      _mm512_mask_storeu_epi32(to, words, both);
    }
  }

  // The words of pairs of rows: to[q * ld_to + column], of `rows` rows; zero from `columns` on up to ld_to.
  static void round_rows(const float* from, int ld, int rows, int columns, Word* to, int ld_to) {
    alignas(64) static const unsigned short kInterleave[32] = {0,  16, 1,  17, 2,  18, 3,  19, 4,  20, 5,
                                                               21, 6,  22, 7,  23, 8,  24, 9,  25, 10, 26,
                                                               11, 27, 12, 28, 13, 29, 14, 30, 15, 31};
    const __m512i interleave = _mm512_load_si512(kInterleave);
    for (int r = 0; r < rows; r += 2, from += 2 * size_t(ld), to += ld_to)
      for (int c = 0; c < ld_to; c += 16) {
        const int left = columns - c;
        const __mmask16 mask = left >= 16 ? 0xffff : left > 0 ? __mmask16((1u << left) - 1) : 0;
        const __m512 first = _mm512_maskz_loadu_ps(mask, from + c),
                     second = _mm512_maskz_loadu_ps(r + 1 < rows ? mask : __mmask16(0), from + ld + c);
        _mm512_storeu_si512(to + c, _mm512_permutexvar_epi16(interleave, (__m512i)_mm512_cvtne2ps_pbh(second, first)));
      }
  }
};

}  // namespace synpo::SYNPO_TARGET
