// RMSProp (Tieleman and Hinton 2012) with L2 weight decay added to the gradient, over a flat array, and clipping of a
// gradient's length.
#pragma once
#include <cstddef>

#include "base/parallel.h"

namespace synpo {

struct RmsPropOptions {
  double learning_rate = 2.5e-5, smoothing = 0.99, epsilon = 1e-8, weight_decay = 1e-4;
};

// One step: g = factor * gradient + weight_decay * parameter, v = smoothing * v + (1 - smoothing) * g^2,
// parameter -= learning_rate * g / (sqrt(v) + epsilon).
template <class T>
void rmsprop_step(Parallel& parallel, const RmsPropOptions& options, size_t count, T factor, const T* gradient,
                  T* parameter, T* v);

// Sum of squares, in double; the same for every number of threads.
template <class T>
double sum_of_squares(Parallel& parallel, size_t count, const T* values);

// The factor for a gradient of this length, so that it is no longer than `limit`.
double clip_factor(double length, double limit);

}  // namespace synpo
