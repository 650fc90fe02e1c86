#include "policy/head/bilinear_form.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernels.h"

namespace synpo {
namespace {
constexpr int kRows = 64;  // of a shard
}  // namespace

template <class T>
BilinearForm<T>::BilinearForm(int actions, int feature, int basis, int action_embedding, Layout& parameters)
    : actions_(actions), feature_(feature), basis_(basis), columns_(action_embedding > 0 ? action_embedding : actions),
      theta_(parameters.add("theta", {columns_, feature, basis})) {
  if (action_embedding > 0) phi_ = parameters.add("phi", {actions, columns_});
}

// Learned phi(a) start at about the length of one-hot ones, so that scores start alike in both forms.
template <class T>
void BilinearForm<T>::initialise(InitStream& stream, T* parameters) const {
  stream.uniform(parameters + theta_, matrix_size() * basis_, 1 / std::sqrt(double(actions_) * feature_ * basis_));
  if (!direct()) stream.normal(parameters + phi_, size_t(actions_) * columns_, 1 / std::sqrt(double(columns_)));
}

template <class T>
void BilinearForm<T>::compose(Parallel& parallel, int rows, const T* coefficients, const T* parameters, T* w) const {
  const int size = int(matrix_size());
  parallel.run(shard_count(rows, kRows), [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    gemm(Op::kAsIs, Op::kTransposed, range.size(), size, basis_, coefficients + size_t(range.begin) * basis_, basis_,
         parameters + theta_, basis_, w + size_t(range.begin) * size, size);
  });
}

template <class T>
void BilinearForm<T>::compose_backward(Parallel& parallel, int rows, const T* coefficients, const T* dw,
                                       const T* parameters, T* dcoefficients, T* gradient) const {
  const int size = int(matrix_size());
  parallel.run(shard_count(rows, kRows), [&](int shard, int) {
    const Range range = shard_range(rows, kRows, shard);
    gemm(Op::kAsIs, Op::kAsIs, range.size(), basis_, size, dw + size_t(range.begin) * size, size, parameters + theta_,
         basis_, dcoefficients + size_t(range.begin) * basis_, basis_);
  });
  parallel.run(shard_count(size, kRows), [&](int shard, int) {
    const Range range = shard_range(size, kRows, shard);
    gemm(Op::kTransposed, Op::kAsIs, range.size(), basis_, rows, dw + range.begin, size, coefficients, basis_,
         gradient + theta_ + size_t(range.begin) * basis_, basis_, true);
  });
}

template <class T>
void BilinearForm<T>::apply(const T* w, const T* psi, T* q) const {
  for (int c = 0; c < columns_; ++c) q[c] = kernels<T>().dot(feature_, psi, w + size_t(c) * feature_);
}

template <class T>
void BilinearForm<T>::apply_backward(const T* w, const T* psi, const T* dq, T* dpsi, T* dw) const {
  for (int c = 0; c < columns_; ++c, w += feature_, dw += feature_) {
    const T d = dq[c];
    for (int i = 0; i < feature_; ++i) {
      dpsi[i] += d * w[i];
      dw[i] += d * psi[i];
    }
  }
}

template <class T>
void BilinearForm<T>::scores(int rows, const T* q, const T* parameters, T* scores) const {
  if (direct())
    std::copy_n(q, size_t(rows) * actions_, scores);
  else
    gemm(Op::kAsIs, Op::kTransposed, rows, actions_, columns_, q, columns_, parameters + phi_, columns_, scores,
         actions_);
}

template <class T>
void BilinearForm<T>::scores_backward(int rows, const T* dscores, const T* parameters, T* dq) const {
  if (direct())
    std::copy_n(dscores, size_t(rows) * actions_, dq);
  else
    gemm(Op::kAsIs, Op::kAsIs, rows, columns_, actions_, dscores, actions_, parameters + phi_, columns_, dq, columns_);
}

template <class T>
void BilinearForm<T>::phi_backward(int rows, const T* q, const T* dscores, T* gradient) const {
  if (!direct())
    gemm(Op::kTransposed, Op::kAsIs, actions_, columns_, rows, dscores, actions_, q, columns_, gradient + phi_,
         columns_, true);
}

template <class T>
T BilinearForm<T>::score(const T* q, int action, const T* parameters) const {
  return direct() ? q[action] : kernels<T>().dot(columns_, q, parameters + phi_ + size_t(action) * columns_);
}

template <class T>
void BilinearForm<T>::score_backward(const T* q, int action, T dscore, const T* parameters, T* dq, T* gradient) const {
  if (direct()) {
    std::fill_n(dq, columns_, T(0));
    dq[action] = dscore;
    return;
  }
  const T* phi = parameters + phi_ + size_t(action) * columns_;
  T* dphi = gradient + phi_ + size_t(action) * columns_;
  for (int c = 0; c < columns_; ++c) {
    dq[c] = dscore * phi[c];
    dphi[c] += dscore * q[c];
  }
}

template <class T>
void BilinearForm<T>::prepare_inference(const T* parameters) {
  if (!direct()) phi_packed_.pack(Op::kTransposed, columns_, actions_, parameters + phi_, columns_);
}

template <class T>
void BilinearForm<T>::infer(int rows, const T* q, T* scores) const {
  if (direct())
    std::copy_n(q, size_t(rows) * actions_, scores);
  else
    gemm(Op::kAsIs, rows, q, columns_, phi_packed_, scores, actions_);
}

template <class T>
void BilinearForm<T>::make_action_matrix(int action, const T* parameters, T* matrix) const {
  const size_t size = action_matrix_size();
  if (direct()) {
    std::copy_n(parameters + theta_ + action * size, size, matrix);
    return;
  }
  for (int row = 0; row < feature_; ++row) {
    const size_t at = size_t(row) * basis_;
    gemm(Op::kAsIs, Op::kAsIs, 1, basis_, columns_, parameters + phi_ + size_t(action) * columns_, columns_,
         parameters + theta_ + at, int(size), matrix + at, int(size));
  }
}

template <class T>
void BilinearForm<T>::use_actions(Parallel& parallel, const std::vector<int>& actions, const T* parameters) {
  used_ = actions;
  if (direct()) return;
  const int count = int(actions.size());
  const size_t size = action_matrix_size();
  T* phi = phi_used_.grow(size_t(count) * columns_);
  for (int i = 0; i < count; ++i)
    std::copy_n(parameters + phi_ + size_t(actions[i]) * columns_, columns_, phi + size_t(i) * columns_);
  T* matrices = matrices_.grow(count * size);
  dmatrices_.grow(count * size);
  dmatrices_.zero();
  parallel.run(feature_, [&](int row, int) {
    const size_t at = size_t(row) * basis_;
    gemm(Op::kAsIs, Op::kAsIs, count, basis_, columns_, phi, columns_, parameters + theta_ + at, int(size),
         matrices + at, int(size));
  });
}

template <class T>
const T* BilinearForm<T>::action_matrix(int number, const T* parameters) const {
  return direct() ? parameters + theta_ + used_[number] * action_matrix_size()
                  : matrices_.data() + number * action_matrix_size();
}

template <class T>
T* BilinearForm<T>::action_matrix_gradient(int number, T* gradient) {
  return direct() ? gradient + theta_ + used_[number] * action_matrix_size()
                  : dmatrices_.data() + number * action_matrix_size();
}

template <class T>
void BilinearForm<T>::finish_actions(Parallel& parallel, const T* parameters, T* gradient) {
  if (direct()) return;
  const int count = int(used_.size()), size = int(action_matrix_size());
  const T *phi = phi_used_.data(), *d = dmatrices_.data();
  parallel.run(feature_, [&](int row, int) {
    const size_t at = size_t(row) * basis_;
    gemm(Op::kTransposed, Op::kAsIs, columns_, basis_, count, phi, columns_, d + at, size, gradient + theta_ + at, size,
         true);
  });
  std::vector<T> dphi(size_t(count) * columns_);
  gemm(Op::kAsIs, Op::kTransposed, count, columns_, size, d, size, parameters + theta_, size, dphi.data(), columns_);
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < columns_; ++c)
      gradient[phi_ + size_t(used_[i]) * columns_ + c] += dphi[size_t(i) * columns_ + c];
}

template class BilinearForm<float>;
template class BilinearForm<double>;

}  // namespace synpo
