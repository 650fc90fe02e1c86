// Safetensors files: an 8-byte little-endian length, a JSON header, then the tensors' bytes. Readable by numpy and
// torch as they are.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/files/io.h"

namespace synpo {

enum class TensorType { kBF16, kF16, kF32, kF64, kI32, kI64, kU8, kU64 };
size_t type_size(TensorType type);
// As the file has it: "F32".
const char* type_text(TensorType type);

struct Tensor {
  TensorType type = TensorType::kF32;
  std::vector<int64_t> shape;
  std::string bytes;
  // The number of elements.
  size_t count() const;
};

struct SafeTensors {
  std::map<std::string, std::string> metadata;
  std::map<std::string, Tensor> tensors;

  template <class T>
  void add(const std::string& name, const std::vector<int64_t>& shape, const T* values, size_t count);
  // Throws kData when the tensor is missing or has another type or count. As floats F16 and BF16 are read too, exactly;
  // what F16 holds that is not finite becomes NaN.
  template <class T>
  void get(const std::string& name, T* values, size_t count) const;
  template <class T>
  std::vector<T> get(const std::string& name) const;
  // The 64 bits of numbers without a sign, which are written as I64, a type that every reader of the format has; U64
  // does as well. Throws kData for another type.
  std::vector<uint64_t> get_bits(const std::string& name) const;
  void add_bits(const std::string& name, const std::vector<uint64_t>& values);
  bool has(const std::string& name) const { return tensors.count(name) > 0; }
  // A metadata entry; throws kData when it is missing.
  const std::string& meta(const std::string& key) const;
};

// Throws kData for anything that is not a whole, well-formed file; memory is taken only as bytes arrive.
SafeTensors read_safetensors(Input& input);
// Tensors by the width of their types, then by name, header keys sorted: the same content gives the same bytes. Throws
// kData where read_safetensors() would refuse the header for its size.
std::string format_safetensors(const SafeTensors& file);

}  // namespace synpo
