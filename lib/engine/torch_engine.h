// The engine of LibTorch: a plug-in (lib/torch), which is loaded when it is asked for.
#pragma once
#include <memory>
#include <string>

#include "base/error.h"
#include "engine/engine.h"
#include "policy/policy_shape.h"

namespace synpo {

constexpr char kTorchPluginFile[] = "libsynpo_torch.so";

struct TorchSettings {
  std::string device;     // as LibTorch names it: "cpu", "cuda:0"
  std::string precision;  // "float32", "tf32", "bf16"
  int threads = 1;        // of the CPU
  bool graphs = true;     // on CUDA, updates and scores are recorded once and replayed
};

// The policy must live as long. Throws kUnavailable where the plug-in is not there (kNoPlugin), is of another version,
// or cannot compute on the device. It is looked for as $SYNPO_TORCH says, beside the program, and in ../lib/synpo.
constexpr Cause kNoPlugin{"no plug-in of LibTorch"};
std::unique_ptr<Engine> make_torch_engine(const TorchSettings& settings, const std::string& method,
                                          const PolicyShape& shape, Policy<float>& policy);

}  // namespace synpo
