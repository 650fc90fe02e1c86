// How tensors start.
#pragma once
#include <cmath>
#include <cstddef>

#include "base/random.h"

namespace synpo {

// Glorot and Bengio (2010): a dense layer's weights start uniformly within this bound.
inline double xavier_bound(int in, int out) { return std::sqrt(6.0 / (in + out)); }

// Random numbers for one tensor after another, each from a stream of its own, so that a tensor's values depend on its
// place in the order alone.
class InitStream {
 public:
  // `group` keeps the parts of a network apart.
  InitStream(uint64_t seed, uint64_t group) : seed_(seed), group_(group) {}
  // Uniform within [-bound, bound).
  template <class T>
  void uniform(T* values, size_t count, double bound) {
    fill(values, count, [&](Random& random) { return bound * (2 * random.uniform() - 1); });
  }
  template <class T>
  void normal(T* values, size_t count, double sd) {
    fill(values, count, [&](Random& random) { return sd * random.normal(); });
  }

 private:
  template <class T, class Draw>
  void fill(T* values, size_t count, Draw draw) {
    Random random(seed_, Purpose::kInit, group_, next_++);
    for (size_t i = 0; i < count; ++i) values[i] = T(draw(random));
  }
  uint64_t seed_, group_, next_ = 0;
};

}  // namespace synpo
