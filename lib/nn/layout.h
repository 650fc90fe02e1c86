// Named tensors in one flat array: parameters, their gradients, moments and averages all share one layout.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace synpo {

struct TensorInfo {
  std::string name;
  std::vector<int> shape;
  size_t offset, size;
};

class Layout {
 public:
  // Appends a tensor and returns its offset. Offsets are multiples of 16, so that tensors are aligned.
  size_t add(const std::string& name, const std::vector<int>& shape) {
    size_t size = 1;
    for (const int extent : shape) size *= size_t(extent);
    tensors_.push_back({name, shape, total_, size});
    total_ += (size + 15) / 16 * 16;
    return tensors_.back().offset;
  }
  const std::vector<TensorInfo>& tensors() const { return tensors_; }
  size_t total() const { return total_; }
  const TensorInfo* find(const std::string& name) const {
    for (const TensorInfo& tensor : tensors_)
      if (tensor.name == name) return &tensor;
    return nullptr;
  }

 private:
  std::vector<TensorInfo> tensors_;
  size_t total_ = 0;
};

}  // namespace synpo
