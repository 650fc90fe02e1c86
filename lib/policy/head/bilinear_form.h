// psi(s)^T W(z) phi(a) with W(z) = sum_k c_k(z) Theta_k: what scores actions, predicts rewards and, with the
// coefficients taken away, makes x(s, a)_k = psi(s)^T Theta_k phi(a) (supplement, Section 4.1).
//
// Direct form: phi(a) is one-hot, so that Theta_k phi(a) is one tensor theta [A, d, K]. General form: theta [D, d, K]
// and learned phi [A, D]. W costs D d K once a pair, and a state then D d + A D. In both, `columns` is the first extent
// of theta.
#pragma once
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/init.h"
#include "nn/layout.h"

namespace synpo {

template <class T>
class BilinearForm {
 public:
  // `action_embedding` is D; 0: the direct form.
  BilinearForm(int actions, int feature, int basis, int action_embedding, Layout& parameters);

  int actions() const { return actions_; }
  int columns() const { return columns_; }
  size_t matrix_size() const { return size_t(columns_) * feature_; }

  void initialise(InitStream& stream, T* parameters) const;

  // w [rows, columns, d] of coefficients [rows, K].
  void compose(Parallel& parallel, int rows, const T* coefficients, const T* parameters, T* w) const;
  void compose_backward(Parallel& parallel, int rows, const T* coefficients, const T* dw, const T* parameters,
                        T* dcoefficients, T* gradient) const;

  // q [columns] = W psi of one state; dpsi +=, dw +=.
  void apply(const T* w, const T* psi, T* q) const;
  void apply_backward(const T* w, const T* psi, const T* dq, T* dpsi, T* dw) const;

  // scores [rows, A] of q [rows, columns], one thread; dq =, and phi's gradient, which is for one thread at a time, +=.
  void scores(int rows, const T* q, const T* parameters, T* scores) const;
  void scores_backward(int rows, const T* dscores, const T* parameters, T* dq) const;
  void phi_backward(int rows, const T* q, const T* dscores, T* gradient) const;
  // The score of one action, and the same backward.
  T score(const T* q, int action, const T* parameters) const;
  void score_backward(const T* q, int action, T dscore, const T* parameters, T* dq, T* gradient) const;

  // Takes phi over for infer(), which does what scores() does.
  void prepare_inference(const T* parameters);
  void infer(int rows, const T* q, T* scores) const;

  // theta phi(a) [d, K] of one action.
  void make_action_matrix(int action, const T* parameters, T* matrix) const;
  // For x(s, a): the matrices theta phi(a) [d, K] of some different actions. Gradients of them that have come together
  // in action_matrix_gradient() are taken further by finish_actions().
  void use_actions(Parallel& parallel, const std::vector<int>& actions, const T* parameters);
  const T* action_matrix(int number, const T* parameters) const;
  T* action_matrix_gradient(int number, T* gradient);
  void finish_actions(Parallel& parallel, const T* parameters, T* gradient);

 private:
  bool direct() const { return phi_ == kNone; }
  size_t action_matrix_size() const { return size_t(feature_) * basis_; }
  static constexpr size_t kNone = size_t(-1);
  int actions_, feature_, basis_, columns_;
  size_t theta_, phi_ = kNone;
  std::vector<int> used_;
  Buffer<T> phi_used_, matrices_, dmatrices_;  // of the used actions, in the general form
  Packed<T> phi_packed_;                       // for inference
};

extern template class BilinearForm<float>;
extern template class BilinearForm<double>;

}  // namespace synpo
