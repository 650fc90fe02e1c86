#include "nn/dense.h"

#include "nn/gemm.h"

namespace synpo {
namespace {

constexpr int kRows = 64;  // of a shard

// Memory to pack a layer's weight into, for all threads; nothing of it outlives the layer's call.
template <class T>
const Packed<T>& packed(Op op, int k, int n, const T* w, int ldw) {
  thread_local Packed<T> weight;
  weight.pack(op, k, n, w, ldw);
  return weight;
}

}  // namespace

template <class T>
void dense_forward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* b, bool relu, T* y) {
  const Packed<T>& weight = packed(Op::kAsIs, in, out, w, out);
  parallel.run(shard_count(rows, kRows), [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    T* to = y + size_t(range.begin) * out;
    gemm(Op::kAsIs, range.size(), x + size_t(range.begin) * in, in, weight, to, out);
    if (b || relu) kernels<T>().add_bias(range.size(), out, b, relu, to);
  });
}

template <class T>
void dense_backward(Parallel& parallel, int rows, int in, int out, const T* x, const T* w, const T* relu_y, T* dy, T* dx, bool add_dx,
                    T* dw, T* db) {
  const Packed<T>* weight = dx ? &packed(Op::kTransposed, out, in, w, out) : nullptr;
  parallel.run(shard_count(rows, kRows), [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    T* d = dy + size_t(range.begin) * out;
    if (relu_y) kernels<T>().relu_mask(size_t(range.size()) * out, d, relu_y + size_t(range.begin) * out);
    if (dx) gemm(Op::kAsIs, range.size(), d, out, *weight, dx + size_t(range.begin) * in, in, add_dx);
  });
  constexpr int block = 64;
  parallel.run(shard_count(in, block) + 1, [&](int shard, int) {
    if (shard == 0) {
      if (db)
        for (int r = 0; r < rows; ++r)
          for (int c = 0; c < out; ++c) db[c] += dy[size_t(r) * out + c];
      return;
    }
    const Range range = shard_range(in, block, shard - 1);
    gemm(Op::kTransposed, Op::kAsIs, range.size(), out, rows, x + range.begin, in, dy, out, dw + size_t(range.begin) * out, out, true);
  });
}

#define SYNPO_INSTANTIATE(T)                                                                                   \
  template void dense_forward(Parallel&, int, int, int, const T*, const T*, const T*, bool, T*);               \
  template void dense_backward(Parallel&, int, int, int, const T*, const T*, const T*, T*, T*, bool, T*, T*);
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
