// The matrix product of floats in AMX tiles. Part of target.cc.
//
// A tile instruction multiplies bf16 (8 significant bits, rounded to within 2^-8) and adds up in float. Every factor is
// split into two, x = hi + lo, hi the nearest bf16 of x and lo the nearest bf16 of x - hi, which leaves an error of at
// most 2^-16 |x|. Of the four products three are taken:
//     a b ~ a_hi b_hi + a_hi b_lo + a_lo b_hi,
// what is left out is at most 2^-16 |a b|. A product's relative error is thus below 2^-14 (three errors of 2^-16, and
// what they make of one another), a twentieth of that on average; sums are taken in float.
//
// C is computed in squares of 32 x 32: two by two tiles. Both factors lie in blocks of 32 of the inner index, each
// block four tiles: hi of the first 16 rows (of A; columns of B), hi of the other 16, lo of the first, lo of the
// others. A tile's values lie in pairs, which the instruction adds up first; ours are 16 apart in the inner index,
// which takes one shift and one blend to make. A tile of A is 16 rows of the pairs (p, p + 16), one of B is 16 rows,
// rows p and p + 16 of 16 columns in pairs. B is packed so for panels of 32 columns, within blocks of kDepth rows; A is
// split on the way, 32 rows by kDepth at a time.
#pragma once
#include <immintrin.h>

#include "kernel/kernels.h"
#include "kernel/product.h"

namespace synpo::SYNPO_TARGET {

struct AmxProduct {
  static constexpr int kSide = 32;          // of the squares of C, and of the blocks of the inner index
  static constexpr int kTile = 16 * 32;     // bf16 values of a tile
  static constexpr int kBlock = 4 * kTile;  // and of a block
  static constexpr int kDepth = kPackedRows;
  using Half = unsigned short;

  static int round_up(int n) { return (n + kSide - 1) / kSide * kSide; }
  static size_t packed_size(int k, int n) {
    return size_t(round_up(k)) * round_up(n);
  }  // two halves are as long as one float

  static void pack(Op op, int k, int n, const float* b, int ldb, float* packed) {
    Half* to = reinterpret_cast<Half*>(packed);
    for (int begin = 0; begin < k; begin += kDepth) {
      const int end = smaller(k, begin + kDepth);
      for (int first = 0; first < n; first += kSide)
        for (int p = begin; p < end; p += kSide, to += kBlock)
          for (int half = 0; half < 2; ++half) {
            const int column = first + 16 * half;
            Half* hi = to + half * kTile;
            if (op == Op::kAsIs)
              split<Pairs::kOfRows, false>(b + size_t(p) * ldb + column, ldb, k - p, n - column, hi, hi + 2 * kTile);
            else
              split<Pairs::kOfColumns, true>(b + size_t(column) * ldb + p, ldb, n - column, k - p, hi, hi + 2 * kTile);
          }
    }
  }

  static void multiply(Op op, int m, int n, int k, const float* a, int lda, const float* packed, float* c, int ldc,
                       bool accumulate) {
    if (k == 0) return Product<float>::multiply(op, m, n, k, a, lda, packed, c, ldc, accumulate);
    configure();
    alignas(64) Half left[kDepth / kSide * kBlock];
    const Half* right = reinterpret_cast<const Half*>(packed);
    for (int begin = 0; begin < k; begin += kDepth) {
      const int blocks = (smaller(k - begin, kDepth) + kSide - 1) / kSide;
      for (int i = 0; i < m; i += kSide) {
        const bool tall = m - i > 16;  // with 16 rows or fewer the lower tiles of C have nothing in them
        for (int q = 0; q < blocks; ++q)
          for (int half = 0; half < 1 + tall; ++half) {
            const int row = i + 16 * half, p = begin + q * kSide;
            Half* hi = left + q * kBlock + half * kTile;
            if (op == Op::kAsIs)
              split<Pairs::kOfColumns, false>(a + size_t(row) * lda + p, lda, m - row, k - p, hi, hi + 2 * kTile);
            else
              split<Pairs::kOfRows, true>(a + size_t(p) * lda + row, lda, k - p, m - row, hi, hi + 2 * kTile);
          }
        for (int first = 0; first < n; first += kSide)
          (tall ? square<true> : square<false>)(blocks, left, right + size_t(first / kSide) * blocks * kBlock,
                                                smaller(kSide, m - i), smaller(kSide, n - first),
                                                c + size_t(i) * ldc + first, ldc, accumulate || begin > 0);
      }
      right += size_t(round_up(n) / kSide) * blocks * kBlock;
    }
  }

 private:
  // Square [rows, columns] of C += left right, over `blocks` blocks. Tiles 0 to 3 are C's, 4 and 5 A's, 6 and 7 B's;
  // without kTall, for at most 16 rows, 2, 3 and 5 are left alone.
  template <bool kTall>
  static void square(int blocks, const Half* left, const Half* right, int rows, int columns, float* c, int ldc,
                     bool accumulate) {
    alignas(64) float edge[kSide * kSide];
    const bool whole = rows == (kTall ? kSide : 16) && columns == kSide;
    float* to = whole ? c : edge;
    const int stride = whole ? ldc : kSide;
    for (int i = 0; !whole && accumulate && i < rows; ++i)
      for (int j = 0; j < columns; ++j) edge[i * kSide + j] = c[size_t(i) * ldc + j];
    asm volatile("" ::: "memory");  // the compiler is not told what tile instructions read and write
    if (accumulate) {
      _tile_loadd(0, to, stride * 4);
      _tile_loadd(1, to + 16, stride * 4);
      if constexpr (kTall) {
        _tile_loadd(2, to + 16 * stride, stride * 4);
        _tile_loadd(3, to + 16 * stride + 16, stride * 4);
      }
    } else {
      _tile_zero(0);
      _tile_zero(1);
      if constexpr (kTall) {
        _tile_zero(2);
        _tile_zero(3);
      }
    }
    for (int q = 0; q < blocks; ++q, left += kBlock, right += kBlock) {
      _tile_loadd(4, left, 64);
      if constexpr (kTall) _tile_loadd(5, left + kTile, 64);
      _tile_loadd(6, right + 2 * kTile, 64);
      _tile_loadd(7, right + 3 * kTile, 64);
      add_products<kTall>();
      _tile_loadd(6, right, 64);
      _tile_loadd(7, right + kTile, 64);
      add_products<kTall>();
      _tile_loadd(4, left + 2 * kTile, 64);
      if constexpr (kTall) _tile_loadd(5, left + 3 * kTile, 64);
      add_products<kTall>();
    }
    _tile_stored(0, to, stride * 4);
    _tile_stored(1, to + 16, stride * 4);
    if constexpr (kTall) {
      _tile_stored(2, to + 16 * stride, stride * 4);
      _tile_stored(3, to + 16 * stride + 16, stride * 4);
    }
    asm volatile("" ::: "memory");
    if (whole) return;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) c[size_t(i) * ldc + j] = edge[i * kSide + j];
  }

  template <bool kTall>
  static void add_products() {
    _tile_dpbf16ps(0, 4, 6);
    _tile_dpbf16ps(1, 4, 7);
    if constexpr (!kTall) return;
    _tile_dpbf16ps(2, 5, 6);
    _tile_dpbf16ps(3, 5, 7);
  }

  // Once a thread: all eight tiles are 16 rows of 64 bytes.
  static void configure() {
    static thread_local bool done = false;
    if (done) return;
    struct {
      unsigned char palette = 1, start_row = 0, reserved[14] = {};
      unsigned short row_bytes[16] = {64, 64, 64, 64, 64, 64, 64, 64};
      unsigned char rows[16] = {16, 16, 16, 16, 16, 16, 16, 16};
    } shape;
    _tile_loadconfig(&shape);
    done = true;
  }

  // A tile's pairs are 16 apart in the inner index: rows r and r + 16 of what lies in memory (kOfRows), or columns.
  enum class Pairs { kOfRows, kOfColumns };

  // Splits what lies at `from`, 32 x 16 (pairs of rows) or 16 x 32 (pairs of columns), zero beyond rows and columns,
  // into two tiles; kFlip exchanges the tile's rows and columns, pairs staying pairs.
  template <Pairs pairs, bool kFlip>
  static void split(const float* from, int ld, int rows, int columns, Half* hi, Half* lo) {
    constexpr bool kOfRows = pairs == Pairs::kOfRows;
    if (rows >= (kOfRows ? 32 : 16) && columns >= (kOfRows ? 16 : 32)) {
      split_tile<kFlip>(from, ld, from + (kOfRows ? 16 * size_t(ld) : 16), kOfRows ? 64 * size_t(ld) : 32, hi, lo);
    } else {
      alignas(64) float whole[32 * 16];
      for (int i = 0; i < 32; ++i) {
        const int row = kOfRows ? i : i % 16, column = kOfRows ? 0 : i / 16 * 16,
                  count = row < rows ? columns - column : 0;
        const __mmask16 mask = count >= 16 ? 0xffff : count > 0 ? (1u << count) - 1 : 0;
        _mm512_store_ps(whole + 16 * i, _mm512_maskz_loadu_ps(mask, from + size_t(row) * ld + column));
      }
      split_tile<kFlip>(whole, 16, whole + 16 * 16, 0, hi, lo);
    }
  }

  // The same of 16 x 16 values at `first` and their partners at `second`, both with rows `ld` apart. What lies `ahead`
  // of them will be wanted soon.
  template <bool kFlip>
  static void split_tile(const float* first, size_t ld, const float* second, size_t ahead, Half* hi, Half* lo) {
    __m512i h[16], l[16];
    for (int r = 0; r < 16; ++r, first += ld, second += ld) {
      const __m512 a = _mm512_loadu_ps(first), b = _mm512_loadu_ps(second);
      _mm_prefetch(first + ahead, _MM_HINT_T0);
      _mm_prefetch(second + ahead, _MM_HINT_T0);
      const __m512i a_hi = rounded(a), b_hi = rounded(b);
      const __m512i a_lo = rounded(_mm512_sub_ps(a, as_float(a_hi))), b_lo = rounded(_mm512_sub_ps(b, as_float(b_hi)));
      if constexpr (kFlip) {
        h[r] = upper_halves(a_hi, b_hi);
        l[r] = upper_halves(a_lo, b_lo);
      } else {
        _mm512_store_si512(hi + 32 * r, upper_halves(a_hi, b_hi));
        _mm512_store_si512(lo + 32 * r, upper_halves(a_lo, b_lo));
      }
    }
    if constexpr (kFlip) {
      transpose(h, hi);
      transpose(l, lo);
    }
  }

  // To the nearest bf16, in the upper halves; what the lower ones hold does not count.
  static __m512i rounded(__m512 x) { return _mm512_add_epi32(_mm512_castps_si512(x), _mm512_set1_epi32(0x8000)); }
  static __m512 as_float(__m512i half) {
    return _mm512_castsi512_ps(_mm512_and_si512(half, _mm512_set1_epi32(int(0xffff0000))));
  }

  // Pairs of their upper halves.
  static __m512i upper_halves(__m512i first, __m512i second) {
    return _mm512_mask_blend_epi16(0xaaaaaaaa, _mm512_srli_epi32(first, 16), second);
  }

  // Transposes 16 x 16 values of 32 bits: quarters of 4 x 4, then 4 x 4 of those.
  static void transpose(const __m512i* rows, Half* to) {
    __m512i t[16];
    for (int i = 0; i < 16; i += 4) {
      const __m512i a = _mm512_unpacklo_epi32(rows[i], rows[i + 1]), b = _mm512_unpackhi_epi32(rows[i], rows[i + 1]);
      const __m512i c = _mm512_unpacklo_epi32(rows[i + 2], rows[i + 3]),
                    d = _mm512_unpackhi_epi32(rows[i + 2], rows[i + 3]);
      t[i] = _mm512_unpacklo_epi64(a, c);
      t[i + 1] = _mm512_unpackhi_epi64(a, c);
      t[i + 2] = _mm512_unpacklo_epi64(b, d);
      t[i + 3] = _mm512_unpackhi_epi64(b, d);
    }
    // t[4 g + j] holds in its quarter q the column 4 q + j of rows 4 g ... 4 g + 3.
    for (int j = 0; j < 4; ++j) {
      const __m512i a = _mm512_shuffle_i32x4(t[j], t[4 + j], 0x44), b = _mm512_shuffle_i32x4(t[8 + j], t[12 + j], 0x44);
      const __m512i c = _mm512_shuffle_i32x4(t[j], t[4 + j], 0xee), d = _mm512_shuffle_i32x4(t[8 + j], t[12 + j], 0xee);
      _mm512_store_si512(to + 32 * j, _mm512_shuffle_i32x4(a, b, 0x88));
      _mm512_store_si512(to + 32 * (4 + j), _mm512_shuffle_i32x4(a, b, 0xdd));
      _mm512_store_si512(to + 32 * (8 + j), _mm512_shuffle_i32x4(c, d, 0x88));
      _mm512_store_si512(to + 32 * (12 + j), _mm512_shuffle_i32x4(c, d, 0xdd));
    }
  }
};

}  // namespace synpo::SYNPO_TARGET
