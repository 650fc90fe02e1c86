#include "nn/rmsprop.h"

#include <algorithm>
#include <vector>

#include "kernel/kernels.h"

namespace synpo {
namespace {

constexpr size_t kPart = 1 << 16;  // values of a shard

// Calls body(shard, first, count) for every part.
template <class Body>
void for_parts(Parallel& parallel, size_t count, Body&& body) {
  parallel.run(int((count + kPart - 1) / kPart),
               [&](int shard, int) { body(shard, shard * kPart, std::min(count - shard * kPart, kPart)); });
}

}  // namespace

template <class T>
void rmsprop_step(Parallel& parallel, const RmsPropOptions& options, size_t count, T factor, const T* gradient,
                  T* parameter, T* v) {
  RmsPropFactors<T> factors;
  factors.scale = factor;
  factors.decay = T(options.weight_decay);
  factors.smoothing = T(options.smoothing);
  factors.rate = T(options.learning_rate);
  factors.epsilon = T(options.epsilon);
  for_parts(parallel, count, [&](int, size_t first, size_t size) {
    kernels<T>().rmsprop(size, factors, gradient + first, parameter + first, v + first);
  });
}

template <class T>
double sum_of_squares(Parallel& parallel, size_t count, const T* values) {
  std::vector<double> parts((count + kPart - 1) / kPart);
  for_parts(parallel, count, [&](int shard, size_t first, size_t size) {
    parts[shard] = kernels<T>().sum_of_squares(size, values + first);
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

double clip_factor(double length, double limit) { return length > limit ? limit / length : 1; }

template void rmsprop_step(Parallel&, const RmsPropOptions&, size_t, float, const float*, float*, float*);
template void rmsprop_step(Parallel&, const RmsPropOptions&, size_t, double, const double*, double*, double*);
template double sum_of_squares(Parallel&, size_t, const float*);
template double sum_of_squares(Parallel&, size_t, const double*);

}  // namespace synpo
