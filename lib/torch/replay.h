// Work on a device, of which a GPU keeps a graph: what a thread has done once with the same sizes is recorded the
// second time, and from then on replayed at once instead of being launched kernel by kernel.
#pragma once
#include <torch/types.h>

#include <functional>
#include <memory>
#include <string>

namespace synpo {

class Replay {
 public:
  // Without `graphs`, and on the CPU, work is simply done. Throws c10::Error for a device that is not there.
  Replay(const torch::Device& device, bool graphs);
  ~Replay();

  // Makes this thread work on the device, in its one order, while the returned object lives.
  std::shared_ptr<void> enter() const;

  // Does the work. What it reads and writes outside must stay where it is while `key` is the same: memory that it takes
  // for itself may be taken by work of another key.
  void run(const std::string& key, const std::function<void()>& work);
  // Forgets all that is recorded.
  void forget();

  // Waits until everything is done.
  void finish() const;
  // Memory of the computer that the device reads and writes without the processor's help.
  torch::Tensor host_memory(int64_t bytes) const;
  std::string describe() const;

 private:
  struct Recorder;
  torch::Device device_;
  std::unique_ptr<Recorder> recorder_;  // on CUDA alone
};

}  // namespace synpo
