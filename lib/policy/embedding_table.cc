#include "policy/embedding_table.h"

#include <cmath>

namespace synpo {
namespace {

constexpr double kTiny = 1e-12;  // keeps a row of zeros from being divided by its length

template <class T>
double squared_length(const T* row, int width) {
  double squares = kTiny;
  for (int c = 0; c < width; ++c) squares += double(row[c]) * row[c];
  return squares;
}

}  // namespace

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
    const T factor = T(std::sqrt(width_ / squared_length(row, width_)));
    for (int c = 0; c < width_; ++c) row[c] *= factor;
  }
}

template <class T>
void EmbeddingTable<T>::backward(const T* parameters, T* gradient) const {
  for (int i = 0; i < count_; ++i) {
    const size_t at = size_t(i) * width_;
    const T *u = used_.data() + at, *du = dused_.data() + at;
    T* de = gradient + at_ + at;
    if (!normalise_) {
      for (int c = 0; c < width_; ++c) de[c] += du[c];
      continue;
    }
    double along = 0;
    for (int c = 0; c < width_; ++c) along += double(du[c]) * u[c];
    const double factor = std::sqrt(width_ / squared_length(parameters + at_ + at, width_));
    for (int c = 0; c < width_; ++c) de[c] += T(factor * (du[c] - along / width_ * u[c]));
  }
}

template class EmbeddingTable<float>;
template class EmbeddingTable<double>;

}  // namespace synpo
