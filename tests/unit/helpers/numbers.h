// Random values and errors for the tests of layers and policies.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/random.h"

namespace synpo {

// Uniform in [-1, 1).
template <class T>
std::vector<T> random_values(size_t count, uint64_t seed) {
  Random random(seed, Purpose::kInit, 77);
  std::vector<T> values(count);
  for (T& value : values) value = T(2 * random.uniform() - 1);
  return values;
}

template <class A, class B>
double inner_product(const std::vector<A>& a, const std::vector<B>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double(a[i]) * double(b[i]);
  return sum;
}

// |got - want| / |want| over `count` values; |got| where all that is wanted is zero.
template <class A, class B>
double relative_error(const A* got, const B* want, size_t count) {
  double difference = 0, norm = 0;
  for (size_t i = 0; i < count; ++i) {
    difference += (double(got[i]) - double(want[i])) * (double(got[i]) - double(want[i]));
    norm += double(want[i]) * double(want[i]);
  }
  return std::sqrt(norm > 0 ? difference / norm : difference);
}

template <class A, class B>
double relative_error(const std::vector<A>& got, const std::vector<B>& want) {
  return got.size() == want.size() ? relative_error(got.data(), want.data(), got.size()) : HUGE_VAL;
}

// (f(value + step) - f(value - step)) / 2 step, where f() reads `value`.
template <class T, class F>
double central_difference(T& value, double step, F f) {
  const T kept = value;
  value = T(kept + step);
  const double above = f();
  value = T(kept - step);
  const double below = f();
  value = kept;
  return (above - below) / (2 * step);
}

}  // namespace synpo
