// Pictures to the transformed form of bilinear.h and back. Part of target.cc.
#pragma once
#include "kernel/bilinear.h"
#include "kernel/kernels.h"
#include "kernel/lanes.h"

namespace synpo::SYNPO_TARGET {

// Transposed maps need names of their own to be template arguments.
template <class A>
constexpr auto kInputT = A::kInput.transposed();
template <class A>
constexpr auto kOutputT = A::kOutput.transposed();

// sum + row R of M, from column C on, times a vector of values `stride` apart; zeros and ones cost nothing.
template <const auto& M, int R, int C = 0, bool kFirst = true, class V>
inline V row_times(const V* in, int stride, V sum = V{}) {
  if constexpr (C == M.kColumns) {
    return sum;
  } else if constexpr (M.at[R][C] == 0) {
    return row_times<M, R, C + 1, kFirst>(in, stride, sum);
  } else {
    V term = in[C * stride];
    if constexpr (M.at[R][C] == -1)
      term = -term;
    else if constexpr (M.at[R][C] != 1)
      term = V(term * typename ElementOf<V>::Type(M.at[R][C]));
    return row_times<M, R, C + 1, false>(in, stride, kFirst ? term : V(sum + term));
  }
}

// half = M in and out = half M^T, from row R of M on, unrolled so that all stays in registers.
template <const auto& M, int R = 0, class V>
inline void first_side(const V* in, V* half) {
  if constexpr (R < M.kRows) {
#pragma GCC unroll 8
    for (int c = 0; c < M.kColumns; ++c) half[R * M.kColumns + c] = row_times<M, R>(in + c, M.kColumns);
    first_side<M, R + 1>(in, half);
  }
}
template <const auto& M, int R = 0, class V>
inline void second_side(const V* half, V* out) {
  if constexpr (R < M.kRows) {
#pragma GCC unroll 8
    for (int i = 0; i < M.kRows; ++i) out[i * M.kRows + R] = row_times<M, R>(half + i * M.kColumns, 1);
    second_side<M, R + 1>(half, out);
  }
}

// out [R, R] = M in M^T for in [C, C], both row by row.
template <const auto& M, class V>
inline void transform_2d(const V* in, V* out) {
  V half[M.kRows * M.kColumns];
  first_side<M>(in, half);
  second_side<M>(half, out);
}

template <class T, class A>
struct Tiles {
  static constexpr int kSquare = A::kProducts * A::kProducts;

  static void inputs(TileShape s, const T* x, T* inputs) {
    for_tiles(s, [&](size_t picture, int row, int column, size_t at) {
      for_lanes<T>(s.channels, [&](auto tag, int c) {
        using V = decltype(tag);
        V pixels[A::kIn * A::kIn], factors[kSquare];
        const T* from = x + picture + c;
        for (int i = 0; i < A::kIn; ++i)
          for (int j = 0; j < A::kIn; ++j) {
            const int r = row - A::kPadding + i, q = column - A::kPadding + j;
            pixels[i * A::kIn + j] = inside(s, r, q) ? load<V>(from + (size_t(r) * s.side + q) * s.channels) : V{};
          }
        transform_2d<A::kInput>(pixels, factors);
        for (int p = 0; p < kSquare; ++p) store(inputs + (p * s.stride + at) * s.channels + c, factors[p]);
      });
    });
  }

  static void inputs_adjoint(TileShape s, const T* dinputs, T* dx) {
    for_tiles(s, [&](size_t picture, int row, int column, size_t at) {
      for_lanes<T>(s.channels, [&](auto tag, int c) {
        using V = decltype(tag);
        V factors[kSquare], pixels[A::kIn * A::kIn];
        for (int p = 0; p < kSquare; ++p) factors[p] = load<V>(dinputs + (p * s.stride + at) * s.channels + c);
        transform_2d<kInputT<A>>(factors, pixels);
        T* to = dx + picture + c;
        for (int i = 0; i < A::kIn; ++i)
          for (int j = 0; j < A::kIn; ++j) {
            const int r = row - A::kPadding + i, q = column - A::kPadding + j;
            if (!inside(s, r, q)) continue;
            T* pixel = to + (size_t(r) * s.side + q) * s.channels;
            store(pixel, V(load<V>(pixel) + pixels[i * A::kIn + j]));
          }
      });
    });
  }

  static void outputs(TileShape s, const T* outputs, T* y) {
    for_tiles(s, [&](size_t picture, int row, int column, size_t at) {
      for_lanes<T>(s.channels, [&](auto tag, int c) {
        using V = decltype(tag);
        V factors[kSquare], pixels[A::kOut * A::kOut];
        for (int p = 0; p < kSquare; ++p) factors[p] = load<V>(outputs + (p * s.stride + at) * s.channels + c);
        transform_2d<A::kOutput>(factors, pixels);
        T* to = y + picture + c;
        for (int i = 0; i < A::kOut; ++i)
          for (int j = 0; j < A::kOut; ++j)
            store(to + (size_t(row + i) * s.side + column + j) * s.channels, pixels[i * A::kOut + j]);
      });
    });
  }

  static void outputs_adjoint(TileShape s, const T* dy, T* doutputs) {
    for_tiles(s, [&](size_t picture, int row, int column, size_t at) {
      for_lanes<T>(s.channels, [&](auto tag, int c) {
        using V = decltype(tag);
        V pixels[A::kOut * A::kOut], factors[kSquare];
        const T* from = dy + picture + c;
        for (int i = 0; i < A::kOut; ++i)
          for (int j = 0; j < A::kOut; ++j)
            pixels[i * A::kOut + j] = load<V>(from + (size_t(row + i) * s.side + column + j) * s.channels);
        transform_2d<kOutputT<A>>(pixels, factors);
        for (int p = 0; p < kSquare; ++p) store(doutputs + (p * s.stride + at) * s.channels + c, factors[p]);
      });
    });
  }

  static constexpr Transform<T> table() { return {inputs, inputs_adjoint, outputs, outputs_adjoint}; }

 private:
  static bool inside(TileShape s, int row, int column) {
    return A::kPadding == 0 || (unsigned(row) < unsigned(s.side) && unsigned(column) < unsigned(s.side));
  }

  // Calls body(offset of the sample's picture, tile's first output row and column, row of the transformed tensor).
  template <class Body>
  static void for_tiles(TileShape s, Body&& body) {
    const int per_side = s.side / A::kOut;
    size_t at = 0;
    for (int n = 0; n < s.samples; ++n)
      for (int row = 0; row < per_side; ++row)
        for (int column = 0; column < per_side; ++column)
          body(size_t(n) * s.side * s.side * s.channels, row * A::kOut, column * A::kOut, at++);
  }
};

}  // namespace synpo::SYNPO_TARGET
