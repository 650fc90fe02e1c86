#include "engine/device.h"

#include <cstdlib>
#include <stdexcept>

#include "engine/cpu_engine.h"
#include "engine/torch_engine.h"
#include "kernel/kernels.h"

namespace synpo {
namespace {

// Throws std::invalid_argument for a device of another name.
std::string parse_device(const std::string& name) {
  const bool numbered = name.starts_with("cuda:") && name.size() > 5 && name.size() < 9 &&
                        name.find_first_not_of("0123456789", 5) == std::string::npos;
  if (name != "cpu" && name != "torch-cpu" && name != "cuda" && !numbered)
    throw std::invalid_argument("expected cpu, torch-cpu, cuda or cuda:N");
  return name;
}

std::string torch_name(const std::string& device) {
  return device == "torch-cpu" ? "cpu" : device == "cuda" ? "cuda:0" : device;
}

// To find out what a graph is worth, or where one cannot be recorded.
bool graphs_wanted() {
  const char* value = std::getenv("SYNPO_TORCH_GRAPHS");
  return !value || std::string(value) != "0";
}

// For the whole program: the kernels are one table.
void choose_coarse_products() {
  for (const NamedKernels<float>& target : all_kernels<float>())
    if (target.name == "bf16") return choose_kernels(target.name);
  fail(Exit::kUnavailable,
       "found precision bf16 on the device cpu, whose processor has no products of it (AVX-512 "
       "BF16), expected float32");
}

}  // namespace

void DeviceOptions::add_to(Options& options) {
  options
      .call(0, "device", "DEVICE", "computes on cpu, or with LibTorch on torch-cpu, cuda or cuda:N [cpu]",
            [this](const std::string& name) { device = parse_device(name); })
      .suggest({"cpu", "torch-cpu", "cuda"});
  options.choice(0, "precision", "NAME", "of the products' factors: float32, bf16, or tf32 on a GPU", precision,
                 {"float32", "bf16", "tf32"});
}

std::unique_ptr<Engine> make_engine(const DeviceOptions& options, const Parallel& parallel, const std::string& method,
                                    const PolicyShape& shape, Policy<float>& policy) {
  if (!options.is_cpu())
    return make_torch_engine({torch_name(options.device), options.precision, parallel.threads(), graphs_wanted()},
                             method, shape, policy);
  if (options.precision == "bf16")
    choose_coarse_products();
  else if (options.precision != "float32")
    fail(Exit::kUsage, "found precision ", options.precision, " on the device cpu, expected float32 or bf16");
  return std::make_unique<CpuEngine>(policy);
}

}  // namespace synpo
