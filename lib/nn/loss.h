// Losses of one row, with their gradients.
#pragma once
#include <algorithm>
#include <cmath>

namespace synpo {

// Cross-entropy of softmax(logits [n]) against `label`; dlogits = weight * its gradient.
template <class T>
double cross_entropy(const T* logits, int n, int label, T weight, T* dlogits) {
  const T top = *std::max_element(logits, logits + n);
  T sum = 0;
  for (int i = 0; i < n; ++i) sum += dlogits[i] = std::exp(logits[i] - top);
  for (int i = 0; i < n; ++i) dlogits[i] = weight * (dlogits[i] / sum - (i == label));
  return std::log(double(sum)) - double(logits[label] - top);
}

template <class T>
int argmax(const T* values, int n) {
  return int(std::max_element(values, values + n) - values);
}

}  // namespace synpo
