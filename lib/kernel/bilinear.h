// 3-tap convolutions with fewer products than taps.
//
// A one-dimensional correlation of kIn inputs with three taps w to kOut outputs is written as
//     y = Out ((Weight w) * (In x)),        * element by element, kProducts products,
// and in two dimensions each map is applied along rows, then along columns: kProducts^2 products for kOut^2 outputs,
// each of which is a matrix product over channels. Gradients use the transposed maps (the form is bilinear):
//     dx = In^T ((Weight w) * (Out^T dy)),   dw = Weight^T ((In x) * (Out^T dy)).
//
// Winograd43: Toom-Cook interpolation at 0, 1, -1, 2, -2 and infinity (Winograd's F(4,3)): 6 products for 4 outputs,
// where the direct form takes 12.
//
// Toeplitz2: two pixels with zeros on both sides, y0 = w1 x0 + w2 x1, y1 = w0 x0 + w1 x1. The matrix has equal
// diagonals, hence
//     y0 = w1 (x0 + x1) + (w2 - w1) x1,   y1 = w1 (x0 + x1) + (w0 - w1) x0:    3 products, where the direct form
//     takes 6.
#pragma once

namespace synpo {

template <int R, int C>
struct SmallMatrix {
  double at[R][C];
  static constexpr int kRows = R, kColumns = C;
  constexpr SmallMatrix<C, R> transposed() const {
    SmallMatrix<C, R> out = {};
    for (int r = 0; r < R; ++r)
      for (int c = 0; c < C; ++c) out.at[c][r] = at[r][c];
    return out;
  }
};

struct Winograd43 {
  static constexpr int kIn = 6, kOut = 4, kProducts = 6;
  static constexpr int kPadding = 1;  // the first input lies this many pixels before the first output
  static constexpr SmallMatrix<6, 6> kInput = {{{4, 0, -5, 0, 1, 0},
                                                {0, -4, -4, 1, 1, 0},
                                                {0, 4, -4, -1, 1, 0},
                                                {0, -2, -1, 2, 1, 0},
                                                {0, 2, -1, -2, 1, 0},
                                                {0, 4, 0, -5, 0, 1}}};
  static constexpr SmallMatrix<6, 3> kWeight = {{{1.0 / 4, 0, 0},
                                                 {-1.0 / 6, -1.0 / 6, -1.0 / 6},
                                                 {-1.0 / 6, 1.0 / 6, -1.0 / 6},
                                                 {1.0 / 24, 1.0 / 12, 1.0 / 6},
                                                 {1.0 / 24, -1.0 / 12, 1.0 / 6},
                                                 {0, 0, 1}}};
  static constexpr SmallMatrix<4, 6> kOutput = {
      {{1, 1, 1, 1, 1, 0}, {0, 1, -1, 2, -2, 0}, {0, 1, 1, 4, 4, 0}, {0, 1, -1, 8, -8, 1}}};
};

struct Toeplitz2 {
  static constexpr int kIn = 2, kOut = 2, kProducts = 3, kPadding = 0;
  static constexpr SmallMatrix<3, 2> kInput = {{{1, 1}, {0, 1}, {1, 0}}};
  static constexpr SmallMatrix<3, 3> kWeight = {{{0, 1, 0}, {0, -1, 1}, {1, -1, 0}}};
  static constexpr SmallMatrix<2, 3> kOutput = {{{1, 1, 0}, {1, 0, 1}}};
};

}  // namespace synpo
