// FNV-1a with 64 bits: names contents in files and messages (not against forgery).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace synpo {

class Hash {
 public:
  Hash& add(const void* data, size_t size);
  Hash& add(std::string_view text) { return add(text.data(), text.size()); }
  uint64_t value() const { return value_; }
  static Hash resume(uint64_t value);

 private:
  uint64_t value_ = 0xcbf29ce484222325;
};

// 16 lower-case hexadecimal digits.
std::string hex(uint64_t value);
// The inverse; throws kData when `text` is not 16 hexadecimal digits.
uint64_t parse_hex(const std::string& text);

}  // namespace synpo
