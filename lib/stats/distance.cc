#include "stats/distance.h"

#include <algorithm>
#include <cmath>

namespace synpo {
namespace {

double dot(const double* a, const double* b, int size) {
  double sum = 0;
  for (int i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

double cosine(const double* a, const double* b, int size) {
  const double length_a = std::sqrt(dot(a, a, size)), length_b = std::sqrt(dot(b, b, size));
  if (length_a == 0 || length_b == 0) return length_a == length_b ? 0 : 1;
  return 1 - std::clamp(dot(a, b, size) / length_a / length_b, -1.0, 1.0);
}

double euclidean(const double* a, const double* b, int size) {
  double square = 0;
  for (int i = 0; i < size; ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square);
}

}  // namespace

std::vector<double> distances(const std::vector<double>& values, int rows, int columns, Distance kind) {
  std::vector<double> out(size_t(rows) * rows);
  for (int a = 0; a < rows; ++a)
    for (int b = 0; b < a; ++b) {
      const double* first = values.data() + size_t(a) * columns;
      const double* second = values.data() + size_t(b) * columns;
      out[size_t(a) * rows + b] = out[size_t(b) * rows + a] =
          (kind == Distance::kCosine ? cosine : euclidean)(first, second, columns);
    }
  return out;
}

}  // namespace synpo
