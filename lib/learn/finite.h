// Losses that have become infinite or NaN.
#pragma once
#include <cmath>
#include <cstdint>

#include "base/error.h"

namespace synpo {

constexpr Cause kNotFinite{"a loss that is not finite"};

// Throws kInternal (kNotFinite) unless the loss of update number `update` (from 1) is finite.
inline void check_finite(double loss, int64_t update) {
  if (!std::isfinite(loss)) fail(Exit::kInternal, kNotFinite, "the loss is not finite at update ", update);
}

}  // namespace synpo
