// Some rows of an array.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace synpo {

// `rows` of values [*, width], one after another.
template <class T, class Row>
std::vector<T> gathered(const std::vector<T>& values, const std::vector<Row>& rows, size_t width = 1) {
  std::vector<T> result(rows.size() * width);
  for (size_t i = 0; i < rows.size(); ++i)
    std::copy_n(values.data() + size_t(rows[i]) * width, width, result.data() + i * width);
  return result;
}

}  // namespace synpo
