// A perceptron (perceptron.h) whose weights stay as they are: packed once for both ways, and of gradients that of its
// input alone.
#pragma once
#include <vector>

#include "nn/gemm.h"
#include "nn/layers/perceptron.h"

namespace synpo {

template <class T>
class FrozenPerceptron {
 public:
  FrozenPerceptron(const PerceptronPlace& place, const T* parameters);

  int in() const { return hidden_.k(); }
  int hidden() const { return hidden_.n(); }
  int out() const { return out_.n(); }

  // One thread's part: the outputs y [rows, out] for x [rows, in]. backward() needs h [rows, hidden].
  void forward(int rows, const T* x, T* h, T* y) const;
  // From dy, the gradient of y, that of h, and dx = or, where add_dx, +=.
  void backward(int rows, const T* h, const T* dy, T* dh, T* dx, bool add_dx) const;

 private:
  Packed<T> hidden_, out_, hidden_transposed_, out_transposed_;
  std::vector<T> hidden_bias_, out_bias_;
};

extern template class FrozenPerceptron<float>;
extern template class FrozenPerceptron<double>;

}  // namespace synpo
