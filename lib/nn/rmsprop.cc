#include "nn/rmsprop.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace synpo {
namespace {

constexpr size_t kPart = 1 << 16;  // values of a shard

template <class Body>
void for_parts(Parallel& parallel, size_t count, Body&& body) {
  parallel.run(int((count + kPart - 1) / kPart), [&](int shard, int) { body(shard, shard * kPart, std::min(count, (shard + 1) * kPart)); });
}

}  // namespace

template <class T>
void rmsprop_step(Parallel& parallel, const RmsPropOptions& options, size_t count, const T* gradient, T* parameter, T* v) {
  const T rate = T(options.learning_rate), smoothing = T(options.smoothing), epsilon = T(options.epsilon), decay = T(options.weight_decay);
  for_parts(parallel, count, [&](int, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const T g = gradient[i] + decay * parameter[i];
      v[i] = smoothing * v[i] + (1 - smoothing) * g * g;
      parameter[i] -= rate * g / (std::sqrt(v[i]) + epsilon);
    }
  });
}

template <class T>
double sum_of_squares(Parallel& parallel, size_t count, const T* values) {
  std::vector<double> parts((count + kPart - 1) / kPart, 0);
  for_parts(parallel, count, [&](int shard, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) parts[shard] += double(values[i]) * values[i];
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

double clip_factor(double length, double limit) { return length > limit ? limit / length : 1; }

template <class T>
void scale(Parallel& parallel, size_t count, T factor, T* values) {
  for_parts(parallel, count, [&](int, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) values[i] *= factor;
  });
}

#define SYNPO_INSTANTIATE(T)                                                                          \
  template void rmsprop_step(Parallel&, const RmsPropOptions&, size_t, const T*, T*, T*);             \
  template double sum_of_squares(Parallel&, size_t, const T*);                                        \
  template void scale(Parallel&, size_t, T, T*);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
