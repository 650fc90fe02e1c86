#include "nn/layers/frozen_perceptron.h"

namespace synpo {

template <class T>
FrozenPerceptron<T>::FrozenPerceptron(const PerceptronPlace& place, const T* parameters)
    : hidden_bias_(parameters + place.hidden_bias, parameters + place.hidden_bias + place.hidden),
      out_bias_(parameters + place.out_bias, parameters + place.out_bias + place.out) {
  const T *hidden = parameters + place.hidden_weight, *out = parameters + place.out_weight;
  hidden_.pack(Op::kAsIs, place.in, place.hidden, hidden, place.hidden);
  hidden_transposed_.pack(Op::kTransposed, place.hidden, place.in, hidden, place.hidden);
  out_.pack(Op::kAsIs, place.hidden, place.out, out, place.out);
  out_transposed_.pack(Op::kTransposed, place.out, place.hidden, out, place.out);
}

template <class T>
void FrozenPerceptron<T>::forward(int rows, const T* x, T* h, T* y) const {
  gemm(Op::kAsIs, rows, x, in(), hidden_, h, hidden());
  kernels<T>().add_bias(rows, hidden(), hidden_bias_.data(), true, h);
  gemm(Op::kAsIs, rows, h, hidden(), out_, y, out());
  kernels<T>().add_bias(rows, out(), out_bias_.data(), false, y);
}

template <class T>
void FrozenPerceptron<T>::backward(int rows, const T* h, const T* dy, T* dh, T* dx, bool add_dx) const {
  gemm(Op::kAsIs, rows, dy, out(), out_transposed_, dh, hidden());
  kernels<T>().relu_mask(size_t(rows) * hidden(), dh, h);
  gemm(Op::kAsIs, rows, dh, hidden(), hidden_transposed_, dx, in(), add_dx);
}

template class FrozenPerceptron<float>;
template class FrozenPerceptron<double>;

}  // namespace synpo
