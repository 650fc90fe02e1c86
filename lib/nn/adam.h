// Adam (Kingma and Ba 2014) with L2 weight decay added to the gradient, over a flat array.
#pragma once
#include <cstdint>

#include "base/parallel.h"

namespace synpo {

struct AdamOptions {
  double learning_rate = 0.001, beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8, weight_decay = 0.001;
};

// One step; `step` counts from 1. `m` and `v` are the moments. With decay averaging in [0, 1), `average` (may be null)
// moves towards the parameters: average = averaging * average + (1 - averaging) * parameter.
template <class T>
void adam_step(Parallel& parallel, const AdamOptions& options, int64_t step, size_t count, const T* gradient,
               T* parameter, T* m, T* v, T* average = nullptr, double averaging = 0);

}  // namespace synpo
