// Principal components of a table of values.
#pragma once
#include <vector>

namespace synpo {

struct Pca {
  std::vector<double> scores;     // [rows, components]: the rows, less their mean, along the components
  std::vector<double> axes;       // [components, columns], of length 1 and orthogonal
  std::vector<double> explained;  // [components]: share of the variance, 0 to 1; 0 where nothing varies
};

// Of `values` [rows, columns], by the singular values of the centred table; the components that explain most come
// first. An axis points where its entry of the largest size (the first of them) is positive. Where there are fewer
// components than asked for, the rest is zero.
Pca principal_components(const std::vector<double>& values, int rows, int columns, int components);

}  // namespace synpo
