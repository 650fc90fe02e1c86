// The disentanglement losses (supplement, Section 2): the environment, or task, that a row x comes from is recognised
// by softmax(f(x)^T e) over the embeddings e of all environments, or tasks; f is a perceptron.
#pragma once
#include <string>

#include "base/parallel.h"
#include "nn/buffer.h"
#include "nn/init.h"
#include "nn/layers/perceptron.h"
#include "nn/layout.h"
#include "policy/head/embedding_table.h"

namespace synpo {

template <class T>
class Recogniser {
 public:
  Recogniser(const std::string& name, int in, int hidden, const EmbeddingTable<T>& table, Layout& parameters);
  // One whose perceptron stands there already.
  explicit Recogniser(const PerceptronPlace& place) : f_(place) {}

  void initialise(InitStream& stream, T* parameters) const { f_.initialise(stream, parameters); }
  const Perceptron<T>& perceptron() const { return f_; }

  // The mean cross-entropy of x [rows, in] against truth [rows]. `weight` times its gradients are added to dx
  // (may be null), to the parameters' gradient and to the table's.
  double step(Parallel& parallel, int rows, const T* x, const int* truth, EmbeddingTable<T>& table, double weight,
              const T* parameters, T* dx, T* gradient);

 private:
  Perceptron<T> f_;
  Buffer<T> df_, scores_, dscores_;
};

extern template class Recogniser<float>;
extern template class Recogniser<double>;

}  // namespace synpo
