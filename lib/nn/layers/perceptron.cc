#include "nn/layers/perceptron.h"

#include "nn/layers/dense.h"

namespace synpo {

template <class T>
Perceptron<T>::Perceptron(const std::string& name, int in, int hidden, int out, Layout& parameters)
    : Perceptron({.in = in,
                  .hidden = hidden,
                  .out = out,
                  .hidden_weight = parameters.add(name + ".hidden.weight", {in, hidden}),
                  .hidden_bias = parameters.add(name + ".hidden.bias", {hidden}),
                  .out_weight = parameters.add(name + ".out.weight", {hidden, out}),
                  .out_bias = parameters.add(name + ".out.bias", {out})}) {}

template <class T>
Perceptron<T>::Perceptron(const PerceptronPlace& place)
    : in_(place.in), hidden_(place.hidden), out_(place.out), hidden_weight_(place.hidden_weight),
      hidden_bias_(place.hidden_bias), out_weight_(place.out_weight), out_bias_(place.out_bias) {}

template <class T>
void Perceptron<T>::initialise(InitStream& stream, T* parameters) const {
  stream.uniform(parameters + hidden_weight_, size_t(in_) * hidden_, xavier_bound(in_, hidden_));
  stream.uniform(parameters + out_weight_, size_t(hidden_) * out_, xavier_bound(hidden_, out_));
}

template <class T>
const T* Perceptron<T>::forward(Parallel& parallel, int rows, const T* x, const T* parameters) {
  rows_ = rows;
  T* h = h_.grow(size_t(rows) * hidden_);
  T* y = y_.grow(size_t(rows) * out_);
  dense_forward(parallel, rows, in_, hidden_, x, parameters + hidden_weight_, parameters + hidden_bias_, true, h);
  dense_forward(parallel, rows, hidden_, out_, h, parameters + out_weight_, parameters + out_bias_, false, y);
  return y;
}

template <class T>
void Perceptron<T>::backward(Parallel& parallel, const T* x, T* dy, T* dx, bool add_dx, const T* parameters,
                             T* gradient) {
  T* dh = dh_.grow(size_t(rows_) * hidden_);
  dense_backward<T>(parallel, rows_, hidden_, out_, h_.data(), parameters + out_weight_, nullptr, dy, dh, false,
                    gradient + out_weight_, gradient + out_bias_);
  dense_backward<T>(parallel, rows_, in_, hidden_, x, parameters + hidden_weight_, h_.data(), dh, dx, add_dx,
                    gradient + hidden_weight_, gradient + hidden_bias_);
}

template <class T>
void Perceptron<T>::prepare_inference(const T* parameters) {
  hidden_packed_.pack(Op::kAsIs, in_, hidden_, parameters + hidden_weight_, hidden_);
  out_packed_.pack(Op::kAsIs, hidden_, out_, parameters + out_weight_, out_);
  hidden_bias_values_.assign(parameters + hidden_bias_, parameters + hidden_bias_ + hidden_);
  out_bias_values_.assign(parameters + out_bias_, parameters + out_bias_ + out_);
}

template <class T>
void Perceptron<T>::infer(int rows, const T* x, T* y, Buffer<T>& scratch) const {
  T* h = scratch.grow(size_t(rows) * hidden_);
  gemm(Op::kAsIs, rows, x, in_, hidden_packed_, h, hidden_);
  kernels<T>().add_bias(rows, hidden_, hidden_bias_values_.data(), true, h);
  gemm(Op::kAsIs, rows, h, hidden_, out_packed_, y, out_);
  kernels<T>().add_bias(rows, out_, out_bias_values_.data(), false, y);
}

template class Perceptron<float>;
template class Perceptron<double>;

}  // namespace synpo
