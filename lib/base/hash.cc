#include "base/hash.h"

#include "base/error.h"

namespace synpo {

Hash& Hash::add(const void* data, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(data);
  for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3;
  return *this;
}

Hash Hash::resume(uint64_t value) {
  Hash hash;
  hash.value_ = value;
  return hash;
}

std::string hex(uint64_t value) {
  std::string out(16, '0');
  for (int i = 15; i >= 0; --i, value >>= 4) out[i] = "0123456789abcdef"[value & 15];
  return out;
}

uint64_t parse_hex(const std::string& text) {
  uint64_t value = 0;
  if (text.size() != 16) fail(Exit::kData, "found ", quoted(text), ", expected a hash of 16 hexadecimal digits");
  for (char c : text) {
    const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
    if (digit < 0) fail(Exit::kData, "found ", quoted(text), ", expected a hash of 16 hexadecimal digits");
    value = value << 4 | uint64_t(digit);
  }
  return value;
}

}  // namespace synpo
