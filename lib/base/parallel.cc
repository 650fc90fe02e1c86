#include "base/parallel.h"

#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <ctime>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/error.h"

namespace synpo {
namespace {

// Tells the processor that this thread is waiting in a loop.
inline void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// Processor time of this thread.
int64_t thread_ns() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return int64_t(time.tv_sec) * 1000000000 + time.tv_nsec;
}

// While it lives, this thread takes numbers too small for a normal float as zero. Weights that decay and moments that
// fade end there, and arithmetic on them takes a hundred times as long.
class FlushDenormals {
 public:
#if defined(__x86_64__)
  FlushDenormals() : before_(__builtin_ia32_stmxcsr()) { __builtin_ia32_ldmxcsr(before_ | 0x8040); }  // FTZ and DAZ
  ~FlushDenormals() { __builtin_ia32_ldmxcsr(before_); }

 private:
  unsigned before_;
#elif defined(__aarch64__)
  FlushDenormals() {
    asm volatile("mrs %0, fpcr" : "=r"(before_));
    asm volatile("msr fpcr, %0" ::"r"(before_ | (1ul << 24)));  // FZ
  }
  ~FlushDenormals() { asm volatile("msr fpcr, %0" ::"r"(before_)); }

 private:
  unsigned long before_;
#endif
};

}  // namespace

struct Parallel::Pool {
  std::vector<std::thread> workers;
  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(int, int)>* work = nullptr;
  int shards = 0;
  std::atomic<int> next{0};
  std::atomic<uint64_t> round{0};
  std::atomic<int> busy{0};
  bool stop = false;
  std::exception_ptr error;

  ~Pool() {
    {
      std::lock_guard lock(mutex);
      stop = true;
    }
    wake.notify_all();
    for (std::thread& worker : workers) worker.join();
  }

  void take_shards(int thread) {
    [[maybe_unused]] const FlushDenormals flush;
    for (int shard; (shard = next.fetch_add(1)) < shards;) {
      try {
        (*work)(shard, thread);
      } catch (...) {
        std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        next = shards;  // nobody wants the rest
      }
    }
  }

  void loop(int thread) {
    uint64_t seen = 0;
    while (true) {
      // A network step hands out work many times a millisecond: look for it a while before going to sleep.
      for (int spin = 0; spin < 2000 && round.load(std::memory_order_acquire) == seen; ++spin) relax();
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return stop || round.load() != seen; });
        if (stop) return;
        seen = round.load();
      }
      take_shards(thread);
      if (busy.fetch_sub(1) == 1) {
        std::lock_guard lock(mutex);
        done.notify_one();
      }
    }
  }
};

Parallel::Parallel(int threads) : pool_(std::make_unique<Pool>()) {
  if (threads <= 0) {
    cpu_set_t set;
    threads = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  }
  for (int i = 1; i < threads; ++i) {
    try {
      pool_->workers.emplace_back([pool = pool_.get(), i] { pool->loop(i); });
    } catch (const std::system_error& error) {
      fail(Exit::kUnavailable, "cannot start thread ", i + 1, " of ", threads, ": ", error.code().message());
    }
  }
}

Parallel::~Parallel() = default;

int Parallel::threads() const { return int(pool_->workers.size()) + 1; }

void Parallel::run(int shards, const std::function<void(int, int)>& work) {
  if (!watcher_) return run_unwatched(shards, work);
  std::atomic<int64_t> work_ns{0};
  const TimePoint start = now();
  run_unwatched(shards, [&](int shard, int thread) {
    const int64_t begin = thread_ns();
    work(shard, thread);
    work_ns += thread_ns() - begin;
  });
  watcher_({shards, seconds_since(start), double(work_ns) * 1e-9});
}

void Parallel::run_unwatched(int shards, const std::function<void(int, int)>& work) {
  Pool& pool = *pool_;
  if (pool.workers.empty()) {
    [[maybe_unused]] const FlushDenormals flush;
    for (int shard = 0; shard < shards; ++shard) work(shard, 0);
    return;
  }
  {
    std::lock_guard lock(pool.mutex);
    pool.work = &work;
    pool.shards = shards;
    pool.next = 0;
    pool.busy = int(pool.workers.size());
    pool.error = nullptr;
    pool.round.fetch_add(1, std::memory_order_release);
  }
  pool.wake.notify_all();
  pool.take_shards(0);
  for (int spin = 0; spin < 20000 && pool.busy.load(std::memory_order_acquire) > 0; ++spin) relax();
  std::unique_lock lock(pool.mutex);
  pool.done.wait(lock, [&] { return pool.busy == 0; });
  if (pool.error) std::rethrow_exception(pool.error);
}

}  // namespace synpo
