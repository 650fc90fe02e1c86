#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "base/parallel.h"

namespace synpo {
namespace {

// Philox 4x32 as the paper has it, from the definition.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
  auto [a, b, c, d] = counter;
  for (int round = 0; round < 10; ++round) {
    const uint64_t left = 0xD2511F53ull * a, right = 0xCD9E8D57ull * c;
    a = uint32_t(right >> 32) ^ b ^ key[0];
    b = uint32_t(right);
    c = uint32_t(left >> 32) ^ d ^ key[1];
    d = uint32_t(left);
    key = {key[0] + 0x9E3779B9, key[1] + 0xBB67AE85};
  }
  return {a, b, c, d};
}

TEST(Random, IsPhilox) {
  // Known answers of the Random123 distribution.
  using Block = std::array<uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}), (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));

  Random zero(0, Purpose{0});
  for (const uint32_t word : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}) EXPECT_EQ(zero.next(), word);
  Random random(0x123456789abcdef0, Purpose::kNoise, 17, 4711);
  for (uint32_t block = 0; block < 50; ++block)
    for (const uint32_t word : philox({block, 17, 4711, uint32_t(Purpose::kNoise)},
                                      {0x9abcdef0, 0x12345678 ^ uint32_t(Purpose::kNoise) << 24}))
      ASSERT_EQ(random.next(), word);
}

TEST(Random, StreamsDifferByEverythingThatNamesThem) {
  std::set<std::pair<uint32_t, uint32_t>> firsts;
  size_t streams = 0;
  for (const uint64_t seed : {0ull, 1ull, 1ull << 32, ~0ull})
    for (const Purpose purpose : {Purpose::kPairOrder, Purpose::kEpisodeStart, Purpose::kNoise, Purpose::kSplit})
      for (const uint64_t a : {0, 1, 399})
        for (const uint64_t b : {0ull, 1ull, 1ull << 31, 1ull << 32, (1ull << 32) + 1, 1ull << 62}) {
          Random random(seed, purpose, a, b);
          const uint32_t first = random.next();
          firsts.insert({first, random.next()});
          ++streams;
        }
  EXPECT_EQ(firsts.size(), streams);
}

TEST(Random, BelowIsUnbiased) {
  Random random(1, Purpose::kBatch);
  constexpr int kDraws = 70000;
  int count[7] = {};
  for (int i = 0; i < kDraws; ++i) ++count[random.below(7)];
  for (const int c : count) EXPECT_NEAR(c, kDraws / 7, 5 * std::sqrt(kDraws / 7.0));
  EXPECT_EQ(random.below(1), 0u);
  // Without rejection a product with 3/4 of 2^32 would make every third number twice as likely as the others.
  int thirds[3] = {};
  for (int i = 0; i < 30000; ++i) ++thirds[random.below(3u << 30) % 3];
  for (const int c : thirds) EXPECT_NEAR(c, 10000, 500);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  Random random(2, Purpose::kInit);
  constexpr int kDraws = 100000;
  double sum = 0, squares = 0, normal_sum = 0, normal_squares = 0, normal_fourth = 0, neighbours = 0, before = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u;
    squares += u * u;
  }
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    normal_sum += z;
    normal_squares += z * z;
    normal_fourth += z * z * z * z;
    neighbours += z * before;
    before = z;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);
  EXPECT_NEAR(squares / kDraws, 1 / 3.0, 0.005);
  EXPECT_NEAR(normal_sum / kDraws, 0, 0.016);
  EXPECT_NEAR(normal_squares / kDraws, 1, 0.025);
  EXPECT_NEAR(normal_fourth / kDraws, 3, 0.16);
  EXPECT_NEAR(neighbours / kDraws, 0, 0.016);
}

}  // namespace
}  // namespace synpo
