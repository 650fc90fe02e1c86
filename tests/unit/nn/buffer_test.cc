#include "nn/buffer.h"

#include <gtest/gtest.h>

#include "nn/gemm.h"

namespace synpo {
namespace {

TEST(Buffer, GrowsAndMoves) {
  Buffer<float> buffer(10);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(buffer.data()) % 64, 0u);
  float* const data = buffer.data();
  EXPECT_EQ(buffer.grow(5), data);
  EXPECT_EQ(buffer.size(), 10u);
  buffer[9] = 4;
  Buffer<float> other = std::move(buffer);
  EXPECT_EQ(other[9], 4);
  other.zero();
  EXPECT_EQ(other[9], 0);
  other.grow(100000);
  EXPECT_EQ(other.size(), 100000u);
}

}  // namespace
}  // namespace synpo
