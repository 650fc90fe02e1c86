// Safetensors files: what was read is written as a file that reads the same.
#include "format/safetensors.h"

#include "fuzz.h"

using namespace synpo;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::accepts([&] {
    fuzz::Bytes bytes(fuzz::text(data, size));
    const SafeTensors file = read_safetensors(bytes.input());
    for (const auto& [name, tensor] : file.tensors)
      fuzz::require(tensor.bytes.size() == tensor.count() * type_size(tensor.type), "a tensor has all of its bytes");
    const std::string again = format_safetensors(file);
    fuzz::Bytes written(again);
    fuzz::require(format_safetensors(read_safetensors(written.input())) == again, "what is written reads the same");
  });
  return 0;
}
