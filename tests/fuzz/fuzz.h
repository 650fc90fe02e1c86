// What the fuzz targets share. A target is a reader and what is done next with what it took: each is one file here, and
// tests/fuzz/run runs them (make fuzz).
//
// A reader may throw Error with one of the codes that its target names, with a message that fits a terminal. A crash, a
// fault that a sanitizer sees, another exception, a hang and too much memory are finds; so is a `require` that fails.
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/files/io.h"

namespace synpo::fuzz {

inline std::string_view text(const uint8_t* data, size_t size) { return {reinterpret_cast<const char*>(data), size}; }

// Ends the process where `holds` is false.
void require(bool holds, const char* what);

// Bytes as a reader gets them: one file in memory, which the next Bytes takes over.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes);
  Input& input() { return input_; }

 private:
  Input input_;
};

// Whether `body` ends without an Error; any other than those of `codes` goes on to the fuzzer.
template <class Body>
bool accepts(Body body, std::initializer_list<Exit> codes = {Exit::kData}) {
  try {
    body();
    return true;
  } catch (const Error& error) {
    bool known = false;
    for (const Exit code : codes) known = known || error.code() == code;
    if (!known) throw;
    const size_t length = std::string_view(error.what()).size();
    require(length > 0 && length <= 2000, "a message has 1 to 2000 bytes");
    return false;
  }
}

// A safetensors file: its header is the input's first line, the tensors are the rest, and zeros where that is too
// short, so that a header gets what it claims, as far as that is little.
std::string with_tensors(std::string_view input);

// A file in memory, by its descriptor.
int memory_file(const char* name);
// What it holds; it is empty after that.
std::string take_contents(int fd);

// What `write` puts into an Output.
template <class Write>
std::string written(Write write) {
  static const int fd = memory_file("output");
  {
    Output output("/dev/fd/" + std::to_string(fd));
    write(output);
    output.finish();
  }
  return take_contents(fd);
}

}  // namespace synpo::fuzz
