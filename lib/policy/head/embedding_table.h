// Learned embeddings e_env or e_task, one row each.
#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "nn/init.h"
#include "nn/layout.h"

namespace synpo {

template <class T>
class EmbeddingTable {
 public:
  // Where `normalise`, rows are scaled to length sqrt(width) before use.
  EmbeddingTable(const std::string& name, int count, int width, bool normalise, Layout& parameters);

  int count() const { return count_; }
  int width() const { return width_; }
  // Where it stands among the parameters, and how many values it has there.
  size_t offset() const { return at_; }
  size_t size() const { return size_t(count_) * width_; }

  // N(0, sd^2); Xavier uniform where sd is 0.
  void initialise(InitStream& stream, double sd, T* parameters) const;

  // Takes over the parameters as they are used from here on; gradients start at zero.
  void use(const T* parameters);
  const T* values() const { return used_.data(); }  // [count, width]
  const T* row(int i) const { return used_.data() + size_t(i) * width_; }
  // Gradients of what is used, to be added to.
  T* gradient() { return dused_.data(); }
  T* gradient_row(int i) { return dused_.data() + size_t(i) * width_; }
  // Row i as a part of a longer row, and that part's gradient back again. Both return where the next part begins.
  T* put(int i, T* to) const { return std::copy_n(row(i), width_, to); }
  const T* add_gradient(int i, const T* from);
  // The parameters' gradient +=. Once after each use().
  void backward(const T* parameters, T* gradient);

 private:
  int count_, width_;
  bool normalise_;
  size_t at_;
  std::vector<T> used_, dused_;
};

extern template class EmbeddingTable<float>;
extern template class EmbeddingTable<double>;

}  // namespace synpo
