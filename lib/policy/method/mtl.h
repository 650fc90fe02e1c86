// The multi-task baseline: SynPo without the environment's embedding and loss. Coefficients come from e_task alone.
#pragma once
#include "policy/method/synpo.h"
#include "policy/policy_shape.h"

namespace synpo {

template <class T>
class Mtl : public SynPo<T> {
 public:
  explicit Mtl(const PolicyShape& shape) : SynPo<T>(shape, SynPo<T>::Context::kTask) {}
};

}  // namespace synpo
