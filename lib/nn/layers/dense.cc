#include "nn/layers/dense.h"

#include <algorithm>

#include "nn/gemm.h"

namespace synpo {
namespace {

// Of the rows of a product, how many are a shard. The other factor is read anew for each: where it fills a processor's
// own cache, shards are larger; where threads are many, smaller. No row depends on the others.
int shard_rows(const Parallel& parallel, int rows, size_t other_factor) {
  const int unit = rows < 512 || other_factor < 1 << 19 ? 64 : 128, wanted = 2 * parallel.threads();
  if (parallel.threads() <= 2 || shard_count(rows, unit) >= wanted) return unit;
  return std::clamp((rows + wanted - 1) / wanted, 8, unit);
}

// Memory to pack a matrix into, for all threads; nothing of it outlives the next call.
template <class T>
const Packed<T>& packed(Parallel& parallel, Op op, int k, int n, const T* b, int ldb) {
  thread_local Packed<T> matrix;
  matrix.pack(parallel, op, k, n, b, ldb);
  return matrix;
}

}  // namespace

template <class T>
void dense_forward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* b, bool relu, T* y) {
  const Packed<T>& weight = packed(parallel, Op::kAsIs, in, out, w, out);
  const int unit = shard_rows(parallel, rows, size_t(in) * out);
  parallel.run(shard_count(rows, unit), [&](int shard, int) {
    const Range range = shard_range(rows, unit, shard);
    T* to = y + size_t(range.begin) * out;
    gemm(Op::kAsIs, range.size(), x + size_t(range.begin) * in, in, weight, to, out);
    if (b || relu) kernels<T>().add_bias(range.size(), out, b, relu, to);
  });
}

template <class T>
void dense_backward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* relu_y, T* dy,
                    T* dx, bool add_dx, T* dw, T* db) {
  const Packed<T>* weight = dx ? &packed(parallel, Op::kTransposed, out, in, w, out) : nullptr;
  const int unit = shard_rows(parallel, rows, size_t(in) * out);
  if (dx || relu_y)
    parallel.run(shard_count(rows, unit), [&](int shard, int) {
      const Range range = shard_range(rows, unit, shard);
      T* d = dy + size_t(range.begin) * out;
      if (relu_y) kernels<T>().relu_mask(size_t(range.size()) * out, d, relu_y + size_t(range.begin) * out);
      if (dx) gemm(Op::kAsIs, range.size(), d, out, *weight, dx + size_t(range.begin) * in, in, add_dx);
    });
  const Packed<T>& right = packed(parallel, Op::kAsIs, rows, out, dy, out);
  const int block = shard_rows(parallel, in, size_t(rows) * out);
  parallel.run(shard_count(in, block) + 1, [&](int shard, int) {
    if (shard == 0) {
      if (db)
        for (int r = 0; r < rows; ++r)
          for (int c = 0; c < out; ++c) db[c] += dy[size_t(r) * out + c];
      return;
    }
    const Range range = shard_range(in, block, shard - 1);
    gemm(Op::kTransposed, range.size(), x + range.begin, in, right, dw + size_t(range.begin) * out, out, true);
  });
}

#define SYNPO_INSTANTIATE(T)                                                                     \
  template void dense_forward(Parallel&, int, int, int, const T*, const T*, const T*, bool, T*); \
  template void dense_backward(Parallel&, int, int, int, const T*, const T*, const T*, T*, T*, bool, T*, T*);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
