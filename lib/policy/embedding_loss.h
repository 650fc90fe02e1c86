// The losses of a method as a function of new embeddings alone, or of these and the recognisers, where all else of it
// stays as it is: what adaptation learns from (learn/adapt.h).
#pragma once
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "policy/losses.h"
#include "world/world.h"

namespace synpo {

class EmbeddingLoss {
 public:
  virtual ~EmbeddingLoss() = default;

  // An episode's steps: psi [size, d], the others [size].
  struct Steps {
    EnvTask pair;
    int size;
    const float* psi;
    const int* label;
    const int* taken;
    const float* reward;
  };
  // Takes episodes in, numbered as they come.
  virtual void add(Parallel& parallel, const std::vector<Steps>& episodes) = 0;
  virtual size_t episodes() const = 0;

  // Means over the steps of the episodes drawn, each as often as it is. In `gradient`, laid out as the policy's
  // parameters, the tables of embeddings are overwritten, old rows with zero, and recognisers that are learned; the
  // rest is left as it was. Bits do not depend on the number of threads.
  virtual Losses step(Parallel& parallel, const std::vector<size_t>& drawn, const LossWeights& weights,
                      const float* parameters, float* gradient) = 0;
};

}  // namespace synpo
