#include "base/random.h"

#include <cmath>

namespace synpo {
namespace {

constexpr uint32_t kMul0 = 0xD2511F53, kMul1 = 0xCD9E8D57;
constexpr uint32_t kWeyl0 = 0x9E3779B9, kWeyl1 = 0xBB67AE85;

std::array<uint32_t, 4> philox(std::array<uint32_t, 4> x, std::array<uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t p0 = uint64_t{kMul0} * x[0], p1 = uint64_t{kMul1} * x[2];
    x = {uint32_t(p1 >> 32) ^ x[1] ^ key[0], uint32_t(p1), uint32_t(p0 >> 32) ^ x[3] ^ key[1], uint32_t(p0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return x;
}

}  // namespace

// The counter's first word runs; (purpose, a) and b fill the rest and the key is the seed, mixed with b's high half.
Random::Random(uint64_t seed, Purpose purpose, uint64_t a, uint64_t b)
    : key_{uint32_t(seed) ^ uint32_t(b >> 32) * 0x85EBCA6B, uint32_t(seed >> 32) ^ (uint32_t(purpose) << 24)},
      counter_{0, uint32_t(a), uint32_t(b), uint32_t(purpose)} {}

uint32_t Random::next() {
  if (used_ == 4) {
    block_ = philox(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[used_++];
}

uint32_t Random::below(uint32_t n) {
  // Lemire's multiply-and-reject.
  uint64_t product = uint64_t{next()} * n;
  if (uint32_t(product) < n) {
    const uint32_t threshold = -n % n;
    while (uint32_t(product) < threshold) product = uint64_t{next()} * n;
  }
  return uint32_t(product >> 32);
}

double Random::uniform() { return next() * 0x1p-32; }

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log((next() + 1.0) * 0x1p-32));
  const double angle = 2 * M_PI * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace synpo
