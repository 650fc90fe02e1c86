// Rows scaled to one length: y = factor x with |y|^2 = square.
#pragma once
#include <cmath>

namespace synpo {

template <class T>
double length_factor(const T* x, int n, double square) {
  double squares = 1e-12;  // keeps a row of zeros from being divided by its length
  for (int c = 0; c < n; ++c) squares += double(x[c]) * x[c];
  return std::sqrt(square / squares);
}

// From the gradient of y, in place, that of x: it loses what points along y.
template <class T>
void length_backward(const T* y, int n, double square, double factor, T* d) {
  double along = 0;
  for (int c = 0; c < n; ++c) along += double(d[c]) * y[c];
  for (int c = 0; c < n; ++c) d[c] = T(factor * (d[c] - along / square * y[c]));
}

}  // namespace synpo
