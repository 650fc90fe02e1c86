#include "nn/softmax.h"

#include <algorithm>
#include <cmath>

namespace synpo {

double softmax(const float* scores, int n, double temperature, double* p) {
  const double top = *std::max_element(scores, scores + n);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += p[i] = std::exp((scores[i] - top) / temperature);
  for (int i = 0; i < n; ++i) p[i] /= sum;
  return top / temperature + std::log(sum);
}

int draw(const double* p, int n, double uniform) {
  for (int i = 0; i + 1 < n; ++i)
    if ((uniform -= p[i]) < 0) return i;
  return n - 1;
}

}  // namespace synpo
