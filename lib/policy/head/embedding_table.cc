#include "policy/head/embedding_table.h"

#include "nn/unit_norm.h"

namespace synpo {

template <class T>
EmbeddingTable<T>::EmbeddingTable(const std::string& name, int count, int width, bool normalise, Layout& parameters)
    : count_(count), width_(width), normalise_(normalise), at_(parameters.add(name, {count, width})) {}

template <class T>
void EmbeddingTable<T>::initialise(InitStream& stream, double sd, T* parameters) const {
  const size_t size = size_t(count_) * width_;
  if (sd > 0)
    stream.normal(parameters + at_, size, sd);
  else
    stream.uniform(parameters + at_, size, xavier_bound(count_, width_));
}

template <class T>
void EmbeddingTable<T>::use(const T* parameters) {
  const size_t size = size_t(count_) * width_;
  used_.assign(parameters + at_, parameters + at_ + size);
  dused_.assign(size, T(0));
  if (!normalise_) return;
  for (int i = 0; i < count_; ++i) {
    T* row = used_.data() + size_t(i) * width_;
    const T factor = T(length_factor(row, width_, width_));
    for (int c = 0; c < width_; ++c) row[c] *= factor;
  }
}

template <class T>
const T* EmbeddingTable<T>::add_gradient(int i, const T* from) {
  T* to = gradient_row(i);
  for (int c = 0; c < width_; ++c) to[c] += from[c];
  return from + width_;
}

template <class T>
void EmbeddingTable<T>::backward(const T* parameters, T* gradient) {
  for (int i = 0; i < count_; ++i) {
    const size_t at = at_ + size_t(i) * width_;
    if (normalise_)
      length_backward(row(i), width_, width_, length_factor(parameters + at, width_, width_), gradient_row(i));
    for (int c = 0; c < width_; ++c) gradient[at + c] += gradient_row(i)[c];
  }
}

template class EmbeddingTable<float>;
template class EmbeddingTable<double>;

}  // namespace synpo
