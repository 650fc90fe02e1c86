// An engine (engine/engine.h) over LibTorch, as the functions of engine/torch_api.h ask for it. One call at a time;
// infer() alone may be called from many threads.
#pragma once
#include <torch/types.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/torch_api.h"
#include "torch/network.h"
#include "torch/replay.h"

namespace synpo {

class Learner {
 public:
  explicit Learner(const TorchConfig& config);

  std::string describe() const { return replay_.describe(); }
  TorchLosses step(const TorchBatch& batch, const TorchStepOptions& options, const float* parameters, float* statistics,
                   float* gradient, float* logits);
  void take(const TorchArrays& arrays);
  void begin_update(const TorchBatch& batch, const TorchStepOptions& options, const TorchAdam& adam);
  TorchLosses end_update(float* logits);
  void give_back(const TorchArrays& arrays);
  void take_ppo(const TorchLayout& value, const TorchPpoArrays& arrays);
  TorchPpoLosses update_ppo(const TorchPpoBatch& batch, const TorchPpoOptions& options);
  void give_back_ppo(const TorchPpoArrays& arrays);
  void prepare_inference(const float* parameters, const float* statistics);
  void infer(int unit, int size, const uint8_t* observations, const int* env, const int* task, float* logits,
             float* psi);

 private:
  // Of the layouts, whose owner may go.
  struct Layout {
    explicit Layout(const TorchLayout& from);
    std::vector<std::string> names;
    std::vector<std::vector<int>> shapes;
    std::vector<TorchTensor> tensors;
    TorchLayout view;
  };
  // Flat arrays on the device and their tensors.
  struct Weights {
    torch::Tensor parameters, statistics;
    Views w, running;
  };
  // The value function of PPO, and what an update of it leaves.
  struct Value {
    explicit Value(const TorchLayout& layout) : layout(layout) {}
    Layout layout;
    torch::Tensor parameters, mean_squares;
    Views w;
    TorchPpoOptions recorded = {};  // of the updates that are recorded
  };
  // A batch on its way to the device and its results on their way back; room for `capacity` states.
  struct Exchange {
    int64_t capacity = 0;
    torch::Tensor host_bytes, host_ints, host_floats, host_results;
    torch::Tensor bytes, ints, floats, results;
  };
  Weights make_weights(bool learned) const;
  void upload(const float* from, const torch::Tensor& to) const;
  void download(const torch::Tensor& from, float* to) const;
  void make_room(Exchange& exchange, int64_t n);
  Inputs send(Exchange& exchange, const TorchBatch& batch, const double* numbers, int count,
              const TorchPpoBatch* ppo = nullptr);
  Inputs inputs(const Exchange& exchange, int64_t n, bool psi) const;
  torch::Tensor flat_gradient(const Layout& layout, const std::vector<torch::Tensor>& gradients) const;
  torch::Tensor values(const torch::Tensor& psi, const Inputs& in) const;
  torch::Tensor total_loss(const Outputs& out, const TorchStepOptions& options) const;
  void put_results(Exchange& exchange, const Outputs& out) const;
  void ask_results(Exchange& exchange, int64_t count) const;
  TorchLosses fetch_results(Exchange& exchange, int64_t n, float* logits) const;
  void adam(const torch::Tensor& gradient, const TorchAdam& options, const torch::Tensor& numbers);

  torch::Device device_;
  Replay replay_;
  NetworkSizes sizes_;
  Layout parameters_, statistics_;
  int64_t observation_bytes_, seam_;
  std::unique_ptr<Head> head_;
  torch::Tensor zeros_;  // what lies between tensors
  Weights step_, training_, inference_;
  torch::Tensor first_moment_, second_moment_, average_, average_statistics_;
  std::unique_ptr<Value> value_;
  Exchange exchange_, inference_exchange_;
  int64_t begun_ = 0;  // states of the update that has begun
  std::mutex inference_mutex_;
};

}  // namespace synpo
