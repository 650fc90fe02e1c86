#include <cstdlib>

#include "base/error.h"
#include "kernel/kernels.h"

#if defined(__x86_64__)
#include <cpuid.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#define SYNPO_DECLARE(target)                  \
  namespace synpo::target {                    \
  extern const Kernels<float> kFloatKernels;   \
  extern const Kernels<double> kDoubleKernels; \
  }
SYNPO_DECLARE(plain)
#if defined(__x86_64__)
SYNPO_DECLARE(avx2)
SYNPO_DECLARE(avx512)
SYNPO_DECLARE(bf16)
SYNPO_DECLARE(amx)
#endif
#undef SYNPO_DECLARE

namespace synpo {
namespace {

#if defined(__x86_64__)
bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }

bool has_avx512() {
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

bool has_bf16() { return has_avx512() && __builtin_cpu_supports("avx512bf16"); }

// The processor must have the tiles, and the system must let this process use them: their registers are large to save.
bool has_amx() {
  constexpr unsigned kTile = 1u << 24, kBf16 = 1u << 22;
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!has_avx512() || !__get_cpuid_count(7, 0, &a, &b, &c, &d) || (d & kTile) == 0 || (d & kBf16) == 0) return false;
#if defined(__linux__)
  constexpr int kRequestPermission = 0x1023, kTileData = 18;  // arch_prctl(2)
  return syscall(SYS_arch_prctl, kRequestPermission, kTileData) == 0;
#else
  return false;
#endif
}
#endif

struct Target {
  const char* name;
  bool runs;
  const Kernels<float>* floats;
  const Kernels<double>* doubles;
  bool coarse = false;  // so that it must be asked for
};

// From plain to best.
const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
    {"plain", true, &plain::kFloatKernels, &plain::kDoubleKernels},
#if defined(__x86_64__)
    {"avx2", has_avx2(), &avx2::kFloatKernels, &avx2::kDoubleKernels},
    {"avx512", has_avx512(), &avx512::kFloatKernels, &avx512::kDoubleKernels},
    {"bf16", has_bf16(), &bf16::kFloatKernels, &bf16::kDoubleKernels, true},
    {"amx", has_amx(), &amx::kFloatKernels, &amx::kDoubleKernels},
#endif
  };
  return all;
}

// The target of that name, or the best one where it is empty.
const Target* find(const std::string& name, const char* who) {
  const Target* found = nullptr;
  std::string names;
  for (const Target& target : targets()) {
    if (!target.runs) continue;
    names += names.empty() ? target.name : std::string(", ") + target.name;
    if (name.empty() ? !target.coarse : name == target.name) found = &target;
  }
  if (!found) fail(Exit::kUsage, who, " is ", quoted(name), ", expected one of ", names);
  return found;
}

const Target*& current() {
  static const Target* target = [] {
    const char* wanted = std::getenv("SYNPO_KERNELS");
    return find(wanted ? wanted : "", "SYNPO_KERNELS");
  }();
  return target;
}

template <class T>
const Kernels<T>* of(const Target& target) {
  if constexpr (sizeof(T) == sizeof(float))
    return target.floats;
  else
    return target.doubles;
}

}  // namespace

template <class T>
const Kernels<T>& kernels() {
  return *of<T>(*current());
}

std::string kernel_target() { return current()->name; }

void choose_kernels(const std::string& target) { current() = find(target, "the target"); }

template <class T>
std::vector<NamedKernels<T>> all_kernels() {
  std::vector<NamedKernels<T>> all;
  for (const Target& target : targets())
    if (target.runs) all.push_back({target.name, of<T>(target)});
  return all;
}

template const Kernels<float>& kernels();
template const Kernels<double>& kernels();
template std::vector<NamedKernels<float>> all_kernels();
template std::vector<NamedKernels<double>> all_kernels();

}  // namespace synpo
