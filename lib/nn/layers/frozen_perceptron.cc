#include "nn/layers/frozen_perceptron.h"

namespace synpo {

template <class T>
FrozenPerceptron<T>::FrozenPerceptron(const std::string& name, const Layout& layout, const T* parameters) {
  const auto take = [&](const std::string& dense, Packed<T>& weight, Packed<T>& transposed, std::vector<T>& bias) {
    const TensorInfo &w = *layout.find(dense + ".weight"), &b = *layout.find(dense + ".bias");
    const int in = w.shape[0], out = w.shape[1];
    weight.pack(Op::kAsIs, in, out, parameters + w.offset, out);
    transposed.pack(Op::kTransposed, out, in, parameters + w.offset, out);
    bias.assign(parameters + b.offset, parameters + b.offset + out);
  };
  take(name + ".hidden", hidden_, hidden_transposed_, hidden_bias_);
  take(name + ".out", out_, out_transposed_, out_bias_);
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
