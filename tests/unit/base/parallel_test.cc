#include "base/parallel.h"

#include <gtest/gtest.h>

#include <vector>

#include <array>
#include <atomic>

#include "base/error.h"
#include "base/hash.h"
#include "base/random.h"
#include "helpers/table_helpers.h"
#include "helpers/temporary.h"

namespace synpo {
namespace {

TEST(Parallel, RunsEveryShardOnce) {
  for (const int threads : {1, 2, 5}) {
    Parallel parallel(threads);
    ASSERT_EQ(parallel.threads(), threads);
    for (const int shards : {0, 1, 2, 16, 1000}) {
      std::vector<std::atomic<int>> runs(shards);
      std::atomic<bool> known = true;
      parallel.run(shards, [&](int shard, int thread) {
        ++runs[shard];
        if (thread < 0 || thread >= threads) known = false;
      });
      for (const auto& count : runs) ASSERT_EQ(count, 1);
      EXPECT_TRUE(known);
    }
  }
}

TEST(Parallel, ManyShortRounds) {
  Parallel parallel(2);
  for (int round = 0; round < 3000; ++round) {
    std::array<int, 7> done = {};
    parallel.run(7, [&](int shard, int) { done[shard] = round; });
    for (const int d : done) ASSERT_EQ(d, round);
  }
}

TEST(Parallel, PassesExceptionsOn) {
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    for (const int bad : {0, 15})
      EXPECT_EQ(thrown([&] {
                  parallel.run(16, [&](int shard, int) {
                    if (shard == bad) fail(Exit::kData, "shard ", shard);
                  });
                }),
                concat("65 shard ", bad));
    std::atomic<int> sum = 0;
    parallel.run(16, [&](int shard, int) { sum += shard; });
    EXPECT_EQ(sum, 120);
  }
}

TEST(Parallel, DenormalNumbersCountAsZeroInWork) {
  const volatile float tiny = 1e-40f;
  for (const int threads : {1, 2}) {
    Parallel parallel(threads);
    std::array<float, 16> doubled;
    parallel.run(16, [&](int shard, int) { doubled[shard] = 2 * tiny; });
    for (const float value : doubled) EXPECT_EQ(value, 0);
    EXPECT_GT(2 * tiny, 0);
  }
}

TEST(Parallel, ShardsCoverTheRange) {
  for (const int n : {0, 1, 31, 32, 33, 100}) {
    int next = 0;
    for (int shard = 0; shard < shard_count(n, 32); ++shard) {
      const Range range = shard_range(n, 32, shard);
      EXPECT_EQ(range.begin, next);
      EXPECT_GT(range.size(), 0);
      next = range.end;
    }
    EXPECT_EQ(next, n);
  }
}

TEST(Parallel, AWatcherSeesEveryRegion) {
  for (const int threads : {1, 3}) {
    Parallel parallel(threads);
    std::vector<int> shards;
    parallel.watch([&](const Parallel::Region& region) {
      shards.push_back(region.shards);
      EXPECT_GT(region.elapsed_s, 0);
      EXPECT_GE(region.work_s, 0);
    });
    std::atomic<int> done{0};
    for (const int count : {5, 0, 7}) parallel.run(count, [&](int, int) { ++done; });
    EXPECT_EQ(done, 12);
    EXPECT_EQ(shards, (std::vector<int>{5, 0, 7}));
  }
}

}  // namespace
}  // namespace synpo
