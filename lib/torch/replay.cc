#include "torch/replay.h"

#include <torch/version.h>

#ifdef SYNPO_TORCH_CUDA
#include <ATen/cuda/CUDAContext.h>
#include <ATen/cuda/CUDAGraph.h>
#include <c10/cuda/CUDAGuard.h>
#include <c10/cuda/CUDAStream.h>

#include <map>
#include <optional>
#include <thread>
#else
#include <stdexcept>
#endif

namespace synpo {

#ifdef SYNPO_TORCH_CUDA

// Graphs share their memory: one is replayed at a time, and what it leaves behind lies outside of it.
struct Replay::Recorder {
  struct Entry {
    bool seen = false;
    std::thread::id
        by;  // cuDNN's and cuBLAS's handles are a thread's own, and none can be made while a graph is recorded
    std::unique_ptr<at::cuda::CUDAGraph> graph;
  };
  c10::cuda::CUDAStream stream;
  bool graphs;
  std::optional<decltype(at::cuda::graph_pool_handle())> pool;
  std::map<std::string, Entry> entries;

  Recorder(const torch::Device& device, bool graphs)
      : stream(c10::cuda::getStreamFromPool(true, device.index())), graphs(graphs) {}

  void run(const std::string& key, const std::function<void()>& work) {
    Entry& entry = entries[key];
    if (!entry.graph) {
      if (!entry.seen || !graphs || entry.by != std::this_thread::get_id()) {
        if (!entry.seen) entry.by = std::this_thread::get_id();
        entry.seen = true;
        work();
        return;
      }
      auto graph = std::make_unique<at::cuda::CUDAGraph>();
      if (!pool) pool = at::cuda::graph_pool_handle();
      graph->capture_begin(*pool);
      work();
      graph->capture_end();
      entry.graph = std::move(graph);
    }
    entry.graph->replay();
  }
};

Replay::Replay(const torch::Device& device, bool graphs) : device_(device) {
  if (device.is_cuda()) recorder_ = std::make_unique<Recorder>(device, graphs);
}

std::shared_ptr<void> Replay::enter() const {
  if (!recorder_) return nullptr;
  return std::make_shared<c10::cuda::CUDAStreamGuard>(recorder_->stream);
}

void Replay::run(const std::string& key, const std::function<void()>& work) {
  if (recorder_)
    recorder_->run(key, work);
  else
    work();
}

void Replay::forget() {
  if (!recorder_) return;
  recorder_->stream.synchronize();
  recorder_->entries.clear();
}

void Replay::finish() const {
  if (recorder_) recorder_->stream.synchronize();
}

torch::Tensor Replay::host_memory(int64_t bytes) const {
  return torch::zeros({bytes}, torch::TensorOptions().dtype(torch::kUInt8).pinned_memory(bool(recorder_)));
}

std::string Replay::describe() const {
  const std::string version = std::string(", LibTorch ") + TORCH_VERSION;
  return (recorder_ ? at::cuda::getDeviceProperties(device_.index())->name : std::string("CPU")) + version;
}

#else

struct Replay::Recorder {};

Replay::Replay(const torch::Device& device, bool) : device_(device) {
  if (!device.is_cpu()) throw std::runtime_error("the plug-in was built against a LibTorch without CUDA");
}
std::shared_ptr<void> Replay::enter() const { return nullptr; }
void Replay::run(const std::string&, const std::function<void()>& work) { work(); }
void Replay::forget() {}
void Replay::finish() const {}
torch::Tensor Replay::host_memory(int64_t bytes) const { return torch::zeros({bytes}, torch::kUInt8); }
std::string Replay::describe() const { return std::string("CPU, LibTorch ") + TORCH_VERSION; }

#endif

Replay::~Replay() = default;

}  // namespace synpo
