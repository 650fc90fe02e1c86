// Time that passes.
#pragma once
#include <chrono>

namespace synpo {

using TimePoint = std::chrono::steady_clock::time_point;
inline TimePoint now() { return std::chrono::steady_clock::now(); }
inline double seconds_between(TimePoint start, TimePoint end) {
  return std::chrono::duration<double>(end - start).count();
}
inline double seconds_since(TimePoint start) { return seconds_between(start, now()); }

}  // namespace synpo
