#include "nn/adam.h"

#include <cmath>

#include "kernel/kernels.h"

namespace synpo {

template <class T>
void adam_step(Parallel& parallel, const AdamOptions& options, int64_t step, size_t count, const T* gradient,
               T* parameter, T* m, T* v, T* average, double averaging) {
  AdamFactors<T> factors;
  factors.beta1 = T(options.beta1);
  factors.beta2 = T(options.beta2);
  factors.decay = T(options.weight_decay);
  factors.rate = T(options.learning_rate / (1 - std::pow(options.beta1, double(step))));
  factors.correction = T(1 / std::sqrt(1 - std::pow(options.beta2, double(step))));
  factors.epsilon = T(options.epsilon);
  factors.keep = T(averaging);
  constexpr size_t kPart = 1 << 16;
  parallel.run(int((count + kPart - 1) / kPart), [&](int shard, int) {
    const size_t begin = shard * kPart, size = begin + kPart < count ? kPart : count - begin;
    kernels<T>().adam(size, factors, gradient + begin, parameter + begin, m + begin, v + begin,
                      average ? average + begin : nullptr);
  });
}

template void adam_step(Parallel&, const AdamOptions&, int64_t, size_t, const float*, float*, float*, float*, float*,
                        double);
template void adam_step(Parallel&, const AdamOptions&, int64_t, size_t, const double*, double*, double*, double*,
                        double*, double);

}  // namespace synpo
