// Work cut into shards that do not depend on the number of threads. Which thread runs a shard never shows in results.
#pragma once
#include <functional>
#include <memory>
#include <utility>

namespace synpo {

class Parallel {
 public:
  // 0 threads means as many as this process may use. Throws kUnavailable where the system does not allow so many.
  explicit Parallel(int threads = 0);
  ~Parallel();
  int threads() const;
  // Calls work(shard, thread) for every shard in [0, shards), with thread in [0, threads()), for scratch memory only.
  // Returns when all are done. An exception is passed on. Numbers too small for a normal float count as zero in `work`.
  void run(int shards, const std::function<void(int shard, int thread)>& work);

  // For measurements: called after each run() with what was done.
  struct Region {
    int shards;
    double elapsed_s, work_s;  // from its begin to its end; of all threads' processor time in `work`
  };
  void watch(std::function<void(const Region&)> watcher) { watcher_ = std::move(watcher); }

 private:
  void run_unwatched(int shards, const std::function<void(int shard, int thread)>& work);

  std::function<void(const Region&)> watcher_;
  struct Pool;
  std::unique_ptr<Pool> pool_;
};

// A half-open part of [0, n).
struct Range {
  int begin, end;
  int size() const { return end - begin; }
};
// [0, n) in shards of `size`, the last one shorter.
inline int shard_count(int n, int size) { return (n + size - 1) / size; }
inline Range shard_range(int n, int size, int shard) {
  return {shard * size, n < (shard + 1) * size ? n : (shard + 1) * size};
}

}  // namespace synpo
