#include "format/safetensors.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/half.h"
#include "format/json_text.h"
#include "format/kind.h"

namespace synpo {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little && sizeof(size_t) == 8,
              "tensors are read and written as they lie in memory, files of more than 4 GiB too");

constexpr uint64_t kHeaderLimit = 100'000'000;  // as other readers of the format have it
constexpr JsonLimits kHeaderLimits = {4, 1 << 20};
constexpr uint64_t kFileLimit = uint64_t{16} << 30;

struct TypeName {
  TensorType type;
  const char* name;
  size_t size;
};
constexpr TypeName kTypes[] = {{TensorType::kBF16, "BF16", 2}, {TensorType::kF16, "F16", 2},
                               {TensorType::kF32, "F32", 4},   {TensorType::kF64, "F64", 8},
                               {TensorType::kI32, "I32", 4},   {TensorType::kI64, "I64", 8},
                               {TensorType::kU8, "U8", 1},     {TensorType::kU64, "U64", 8}};

const TypeName& type_name(TensorType type) {
  return *std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& t) { return t.type == type; });
}

template <class T>
constexpr TensorType type_of() {
  if constexpr (std::is_same_v<T, Half>) return TensorType::kF16;
  if constexpr (std::is_same_v<T, float>) return TensorType::kF32;
  if constexpr (std::is_same_v<T, double>) return TensorType::kF64;
  if constexpr (std::is_same_v<T, int32_t>) return TensorType::kI32;
  if constexpr (std::is_same_v<T, int64_t>) return TensorType::kI64;
  if constexpr (std::is_same_v<T, uint8_t>) return TensorType::kU8;
  if constexpr (std::is_same_v<T, uint64_t>) return TensorType::kU64;
}

// The values of a tensor of two bytes each.
std::vector<float> widened(const Tensor& tensor) {
  std::vector<float> values(tensor.count());
  for (size_t i = 0; i < values.size(); ++i) {
    uint16_t bits;
    std::memcpy(&bits, tensor.bytes.data() + i * sizeof bits, sizeof bits);
    if (tensor.type == TensorType::kBF16)
      values[i] = std::bit_cast<float>(uint32_t(bits) << 16);
    else
      values[i] = is_finite(Half{bits}) ? to_float(Half{bits}) : std::numeric_limits<float>::quiet_NaN();
  }
  return values;
}

uint64_t whole(const std::string& where, const Json& value) {
  if (!value.is_number_unsigned())
    fail(Exit::kData, where, ": found ", quoted(value.dump()), ", expected a whole number from 0 to ", UINT64_MAX);
  return value.get<uint64_t>();
}

// Reads `size` bytes as they come: a length that lies does not take memory.
std::string read_bytes(Input& input, uint64_t size, const char* what) {
  std::string bytes;
  constexpr uint64_t kPart = 1 << 22;
  while (bytes.size() < size) {
    const size_t had = bytes.size(), part = size_t(std::min(kPart, size - had));
    bytes.resize(had + part);
    const size_t got = input.read(bytes.data() + had, part);
    if (got < part)
      fail(Exit::kData, "cannot read ", input.name(), ": it ends at byte ", input.offset(), ", in the middle of ",
           what);
  }
  return bytes;
}

}  // namespace

size_t type_size(TensorType type) { return type_name(type).size; }
const char* type_text(TensorType type) { return type_name(type).name; }

size_t Tensor::count() const {
  size_t count = 1;
  for (const int64_t extent : shape) count *= size_t(extent);
  return count;
}

template <class T>
void SafeTensors::add(const std::string& name, const std::vector<int64_t>& shape, const T* values, size_t count) {
  Tensor& tensor = tensors[name];
  tensor.type = type_of<T>();
  tensor.shape = shape;
  tensor.bytes.assign(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
std::vector<T> SafeTensors::get(const std::string& name) const {
  const auto found = tensors.find(name);
  if (found == tensors.end()) fail(Exit::kData, "no tensor '", name, "'");
  const Tensor& tensor = found->second;
  if constexpr (std::is_same_v<T, float>)
    if (tensor.type == TensorType::kBF16 || tensor.type == TensorType::kF16) return widened(tensor);
  if (tensor.type != type_of<T>())
    fail(Exit::kData, "tensor '", name, "': found type ", type_name(tensor.type).name, ", expected ",
         type_name(type_of<T>()).name);
  std::vector<T> values(tensor.count());
  if (!values.empty()) std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

template <class T>
void SafeTensors::get(const std::string& name, T* values, size_t count) const {
  const std::vector<T> found = get<T>(name);
  if (found.size() != count)
    fail(Exit::kData, "tensor '", name, "': found ", found.size(), " values, expected ", count);
  std::copy(found.begin(), found.end(), values);
}

std::vector<uint64_t> SafeTensors::get_bits(const std::string& name) const {
  const auto found = tensors.find(name);
  if (found != tensors.end() && found->second.type == TensorType::kU64) return get<uint64_t>(name);
  const std::vector<int64_t> values = get<int64_t>(name);
  return {values.begin(), values.end()};
}

void SafeTensors::add_bits(const std::string& name, const std::vector<uint64_t>& values) {
  const std::vector<int64_t> bits(values.begin(), values.end());
  add(name, {int64_t(bits.size())}, bits.data(), bits.size());
}

const std::string& SafeTensors::meta(const std::string& key) const {
  const auto found = metadata.find(key);
  if (found == metadata.end()) fail(Exit::kData, "no metadata '", key, "'");
  return found->second;
}

SafeTensors read_safetensors(Input& input) {
  const auto bad = [&](const auto&... what) { fail(Exit::kData, "cannot read ", input.name(), ": ", what...); };
  uint64_t length = 0;
  const size_t got = input.read(&length, sizeof length);
  if (got == 0) bad("it is empty");
  if (got < sizeof length) bad("it ends at byte ", got, ", expected a safetensors header");
  if (length < 2 || length > kHeaderLimit) {
    const std::string_view beginning(reinterpret_cast<const char*>(&length), sizeof length);
    bad("not a safetensors file (header length ", length, ")", another_kind(beginning, FileKind::kCheckpoint));
  }
  const std::string header = read_bytes(input, length, "the header");
  const Json json = [&] {
    try {
      return parse_json(header, kHeaderLimits);
    } catch (const Error& error) {
      fail(Exit::kData, "cannot read ", input.name(), ": not a safetensors file (the header: ", error.what(), ")");
    }
  }();
  if (!json.is_object()) bad("not a safetensors file (the header is no JSON object)");

  SafeTensors file;
  struct Place {
    uint64_t begin, end;
    std::string name;
  };
  std::vector<Place> places;
  for (const auto& [name, entry] : json.items()) {
    if (name == "__metadata__") {
      if (!entry.is_object()) bad("metadata is no object");
      for (const auto& [key, value] : entry.items()) {
        if (!value.is_string()) bad("metadata ", quoted(key), " is no string");
        file.metadata[key] = value.get<std::string>();
      }
      continue;
    }
    const std::string where = "tensor " + quoted(name);
    if (!entry.is_object() || !entry.contains("dtype") || !entry.contains("shape") || !entry.contains("data_offsets"))
      bad(where, ": expected dtype, shape and data_offsets");
    const auto& type = entry["dtype"];
    const auto known =
        std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& t) { return type == t.name; });
    if (known == std::end(kTypes))
      bad(where, ": type ", quoted(type.dump()), ", this build reads BF16, F16, F32, F64, I32, I64, U8 and U64");
    const auto& shape = entry["shape"];
    const auto& offsets = entry["data_offsets"];
    if (!shape.is_array() || shape.size() > 8) bad(where, ": shape is no array of at most 8 numbers");
    if (!offsets.is_array() || offsets.size() != 2) bad(where, ": data_offsets is no pair");
    Tensor& tensor = file.tensors[name];
    tensor.type = known->type;
    uint64_t bytes = known->size;
    for (const auto& extent : shape) {
      const uint64_t e = whole(where, extent);
      if (e > kFileLimit || (e > 0 && bytes > kFileLimit / e)) bad(where, ": larger than ", kFileLimit, " bytes");
      bytes *= e;
      tensor.shape.push_back(int64_t(e));
    }
    const uint64_t begin = whole(where, offsets[0]), end = whole(where, offsets[1]);
    if (end < begin || end - begin != bytes)
      bad(where, ": data_offsets ", begin, " to ", end, ", expected ", bytes, " bytes");
    places.push_back({begin, end, name});
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return std::tie(a.begin, a.end) < std::tie(b.begin, b.end); });
  uint64_t at = 0;
  for (const Place& place : places) {
    if (place.begin != at) bad("tensor ", quoted(place.name), " begins at ", place.begin, ", expected ", at);
    at = place.end;
    file.tensors[place.name].bytes =
        read_bytes(input, place.end - place.begin, ("tensor " + quoted(place.name)).c_str());
  }
  char more;
  if (input.read(&more, 1) > 0) bad("bytes follow the last tensor");
  return file;
}

std::string format_safetensors(const SafeTensors& file) {
  Json header = Json::object();
  if (!file.metadata.empty()) header["__metadata__"] = file.metadata;
  // The widest types first, so that every tensor is aligned.
  std::vector<std::pair<std::string, const Tensor*>> order;
  for (const auto& [name, tensor] : file.tensors) order.emplace_back(name, &tensor);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return type_size(a.second->type) > type_size(b.second->type); });
  uint64_t at = 0;
  for (const auto& [name, pointer] : order) {
    const Tensor& tensor = *pointer;
    header[name] = {{"dtype", type_name(tensor.type).name},
                    {"shape", tensor.shape},
                    {"data_offsets", {at, at + tensor.bytes.size()}}};
    at += tensor.bytes.size();
  }
  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');
  // What is written can be read.
  if (text.size() > kHeaderLimit)
    fail(Exit::kData, "a header of ", text.size(), " bytes, readers of the format take ", kHeaderLimit);
  parse_json(text, kHeaderLimits);
  const uint64_t length = text.size();
  std::string out(reinterpret_cast<const char*>(&length), sizeof length);
  out.reserve(out.size() + text.size() + at);
  out += text;
  for (const auto& [name, tensor] : order) out += tensor->bytes;
  return out;
}

#define SYNPO_INSTANTIATE(T)                                                                         \
  template void SafeTensors::add(const std::string&, const std::vector<int64_t>&, const T*, size_t); \
  template void SafeTensors::get(const std::string&, T*, size_t) const;                              \
  template std::vector<T> SafeTensors::get(const std::string&) const;
SYNPO_INSTANTIATE(Half)
SYNPO_INSTANTIATE(float)
SYNPO_INSTANTIATE(double)
SYNPO_INSTANTIATE(int32_t)
SYNPO_INSTANTIATE(int64_t)
SYNPO_INSTANTIATE(uint8_t)
SYNPO_INSTANTIATE(uint64_t)
#undef SYNPO_INSTANTIATE

}  // namespace synpo
