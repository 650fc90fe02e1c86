#include "policy/head/recogniser.h"

#include <cstddef>
#include <vector>

#include "kernel/kernels.h"
#include "nn/gemm.h"
#include "nn/loss.h"

namespace synpo {
namespace {
constexpr int kRows = 64;  // of a shard
}  // namespace

template <class T>
Recogniser<T>::Recogniser(const std::string& name, int in, int hidden, const EmbeddingTable<T>& table,
                          Layout& parameters)
    : f_(name, in, hidden, table.width(), parameters) {}

template <class T>
double Recogniser<T>::step(Parallel& parallel, int rows, const T* x, const int* truth, EmbeddingTable<T>& table,
                           double weight, const T* parameters, T* dx, T* gradient) {
  const int width = table.width(), classes = table.count();
  const T* f = f_.forward(parallel, rows, x, parameters);
  T* df = df_.grow(size_t(rows) * width);
  T* scores = scores_.grow(size_t(rows) * classes);
  T* dscores = dscores_.grow(size_t(rows) * classes);
  const int shards = shard_count(rows, kRows);
  std::vector<double> loss(shards, 0);
  parallel.run(shards, [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    const size_t at = size_t(range.begin) * classes, f_at = size_t(range.begin) * width;
    gemm(Op::kAsIs, Op::kTransposed, range.size(), classes, width, f + f_at, width, table.values(), width, scores + at,
         classes);
    for (int i = range.begin; i < range.end; ++i)
      loss[shard] += cross_entropy(scores + size_t(i) * classes, classes, truth[i], T(weight / rows),
                                   dscores + size_t(i) * classes);
    gemm(Op::kAsIs, Op::kAsIs, range.size(), width, classes, dscores + at, classes, table.values(), width, df + f_at,
         width);
  });
  gemm(Op::kTransposed, Op::kAsIs, classes, width, rows, dscores, classes, f, width, table.gradient(), width, true);
  f_.backward(parallel, x, df, dx, true, parameters, gradient);
  double sum = 0;
  for (const double part : loss) sum += part;
  return sum / rows;
}

template class Recogniser<float>;
template class Recogniser<double>;

}  // namespace synpo
