#include "nn/adam.h"

namespace synpo {

template <class T>
void adam_step(Parallel& parallel, const AdamOptions& options, int64_t step, size_t count, const T* gradient, T* parameter, T* m, T* v,
               T* average, double averaging) {
  const T beta1 = T(options.beta1), beta2 = T(options.beta2), decay = T(options.weight_decay);
  const T rate = T(options.learning_rate / (1 - std::pow(options.beta1, double(step))));
  const T correction = T(1 / std::sqrt(1 - std::pow(options.beta2, double(step)))), epsilon = T(options.epsilon);
  const T keep = T(averaging);
  constexpr size_t kPart = 1 << 16;
  parallel.run(int((count + kPart - 1) / kPart), [&](int shard, int) {
    const size_t begin = shard * kPart, end = begin + kPart < count ? begin + kPart : count;
    for (size_t i = begin; i < end; ++i) {
      const T g = gradient[i] + decay * parameter[i];
      m[i] = beta1 * m[i] + (1 - beta1) * g;
      v[i] = beta2 * v[i] + (1 - beta2) * g * g;
      parameter[i] -= rate * m[i] / (std::sqrt(v[i]) * correction + epsilon);
    }
    if (average)
      for (size_t i = begin; i < end; ++i) average[i] = keep * average[i] + (1 - keep) * parameter[i];
  });
}

template void adam_step(Parallel&, const AdamOptions&, int64_t, size_t, const float*, float*, float*, float*, float*, double);
template void adam_step(Parallel&, const AdamOptions&, int64_t, size_t, const double*, double*, double*, double*, double*, double);

}  // namespace synpo
