#include "nn/gemm.h"

#include <Eigen/Core>

namespace synpo {

template <class T>
void gemm(Op op_a, Op op_b, int m, int n, int k, const T* a, int lda, const T* b, int ldb, T* c, int ldc, bool accumulate) {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Stride = Eigen::OuterStride<>;
  using In = Eigen::Map<const Matrix, 0, Stride>;
  const In map_a(a, op_a == Op::kAsIs ? m : k, op_a == Op::kAsIs ? k : m, Stride(lda));
  const In map_b(b, op_b == Op::kAsIs ? k : n, op_b == Op::kAsIs ? n : k, Stride(ldb));
  Eigen::Map<Matrix, 0, Stride> map_c(c, m, n, Stride(ldc));
  const auto product = [&](const auto& left, const auto& right) {
    if (accumulate)
      map_c.noalias() += left * right;
    else
      map_c.noalias() = left * right;
  };
  if (op_a == Op::kAsIs && op_b == Op::kAsIs) product(map_a, map_b);
  if (op_a == Op::kAsIs && op_b == Op::kTransposed) product(map_a, map_b.transpose());
  if (op_a == Op::kTransposed && op_b == Op::kAsIs) product(map_a.transpose(), map_b);
  if (op_a == Op::kTransposed && op_b == Op::kTransposed) product(map_a.transpose(), map_b.transpose());
}

template void gemm(Op, Op, int, int, int, const float*, int, const float*, int, float*, int, bool);
template void gemm(Op, Op, int, int, int, const double*, int, const double*, int, double*, int, bool);

}  // namespace synpo
