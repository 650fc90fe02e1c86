// Where a policy is computed, as the command line says it: --device and --precision.
#pragma once
#include <memory>
#include <string>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/parallel.h"
#include "engine/engine.h"
#include "policy/policy.h"
#include "policy/policy_shape.h"

namespace synpo {

struct DeviceOptions {
  std::string device = "cpu";         // "cpu"; "torch-cpu", "cuda" and "cuda:N" are LibTorch's
  std::string precision = "float32";  // of the products' factors: "float32"; "bf16"; "tf32" with LibTorch

  // Adds --device and --precision.
  void add_to(Options& options);
  bool is_cpu() const { return device == "cpu"; }
};

// An engine for the policy, which must live as long. On the CPU the precision holds for the whole program from then on.
// Throws kUsage for a device of another name or a precision that it doesn't know, kUnavailable (kNoPlugin) where it
// needs a plug-in that is not there, and where there is no such device or processor.
std::unique_ptr<Engine> make_engine(const DeviceOptions& options, const Parallel& parallel, const std::string& method,
                                    const PolicyShape& shape, Policy<float>& policy);

}  // namespace synpo
