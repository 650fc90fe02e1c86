// The losses of a policy's heads, over the rows of a batch.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "nn/loss.h"

namespace synpo {

// Mean cross-entropy of scores [rows, actions] against labels; dscores = its gradient.
template <class T>
double policy_loss(Parallel& parallel, int rows, int actions, const T* scores, const int* label, T* dscores) {
  constexpr int kRows = 64;  // of a shard
  const int shards = shard_count(rows, kRows);
  std::vector<double> loss(shards, 0);
  parallel.run(shards, [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    for (int i = range.begin; i < range.end; ++i)
      loss[shard] +=
          cross_entropy(scores + size_t(i) * actions, actions, label[i], T(1) / T(rows), dscores + size_t(i) * actions);
  });
  double sum = 0;
  for (const double part : loss) sum += part;
  return sum / rows;
}

// Mean squared error of the rewards predicted for each action, [rows, actions], at the action taken; dpredicted =
// weight times its gradient.
template <class T>
double reward_loss(int rows, int actions, const T* predicted, const int* taken, const T* reward, double weight,
                   T* dpredicted) {
  std::fill_n(dpredicted, size_t(rows) * actions, T(0));
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const size_t at = size_t(i) * actions + taken[i];
    const T error = predicted[at] - reward[i];
    sum += double(error) * error;
    dpredicted[at] = T(weight) * 2 * error / T(rows);
  }
  return sum / rows;
}

}  // namespace synpo
