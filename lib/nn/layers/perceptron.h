// A dense layer with ReLU, then a dense layer, over rows: in -> hidden -> out.
#pragma once
#include <string>
#include <vector>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/gemm.h"
#include "nn/init.h"
#include "nn/layout.h"

namespace synpo {

// Sizes of a perceptron, and where its tensors stand among the parameters.
struct PerceptronPlace {
  int in, hidden, out;
  size_t hidden_weight, hidden_bias, out_weight, out_bias;
};

template <class T>
class Perceptron {
 public:
  // Adds NAME.hidden.weight [in, hidden], NAME.hidden.bias, NAME.out.weight [hidden, out] and NAME.out.bias.
  Perceptron(const std::string& name, int in, int hidden, int out, Layout& parameters);
  // One whose tensors stand there already.
  explicit Perceptron(const PerceptronPlace& place);

  int in() const { return in_; }
  int out() const { return out_; }
  PerceptronPlace place() const { return {in_, hidden_, out_, hidden_weight_, hidden_bias_, out_weight_, out_bias_}; }

  // Weights Xavier uniform; biases are left as they are.
  void initialise(InitStream& stream, T* parameters) const;

  // The outputs [rows, out] for x [rows, in]; they stay until the next call. backward() needs x again.
  const T* forward(Parallel& parallel, int rows, const T* x, const T* parameters);
  // From dy, the gradient of the outputs: dx (may be null) = or, where add_dx, +=; the weights' gradients +=.
  void backward(Parallel& parallel, const T* x, T* dy, T* dx, bool add_dx, const T* parameters, T* gradient);

  // Takes the weights over for infer(): y [rows, out] by one thread, to whom `scratch` belongs.
  void prepare_inference(const T* parameters);
  void infer(int rows, const T* x, T* y, Buffer<T>& scratch) const;

 private:
  int in_, hidden_, out_;
  size_t hidden_weight_, hidden_bias_, out_weight_, out_bias_;
  int rows_ = 0;
  Buffer<T> h_, dh_, y_;
  Packed<T> hidden_packed_, out_packed_;  // for inference, with the biases
  std::vector<T> hidden_bias_values_, out_bias_values_;
};

extern template class Perceptron<float>;
extern template class Perceptron<double>;

}  // namespace synpo
