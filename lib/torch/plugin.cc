// The functions of engine/torch_api.h. Nothing that LibTorch throws gets past them.
#include <exception>
#include <string>

#include "torch/learner.h"

namespace synpo {
namespace {

thread_local std::string last_error;

// A c10::Error tells where it was thrown after the first line.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

template <class Body>
int guarded(Body&& body) {
  try {
    body();
    return 0;
  } catch (const std::exception& error) {
    last_error = first_line(error.what());
  } catch (...) {
    last_error = "unknown error";
  }
  return 1;
}

Learner& learner(void* engine) { return *static_cast<Learner*>(engine); }

constexpr TorchApi kApi = {
    kTorchApiVersion,
    [] { return last_error.c_str(); },
    [](void* engine) {
      thread_local std::string text;
      guarded([&] { text = learner(engine).describe(); });
      return text.c_str();
    },
    [](const TorchConfig* config, void** engine) { return guarded([&] { *engine = new Learner(*config); }); },
    [](void* engine) { guarded([&] { delete &learner(engine); }); },
    [](void* engine, const TorchBatch* batch, const TorchStepOptions* options, const float* parameters,
       float* statistics, float* gradient, float* logits, TorchLosses* losses) {
      return guarded(
          [&] { *losses = learner(engine).step(*batch, *options, parameters, statistics, gradient, logits); });
    },
    [](void* engine, const TorchArrays* arrays) { return guarded([&] { learner(engine).take(*arrays); }); },
    [](void* engine, const TorchBatch* batch, const TorchStepOptions* options, const TorchAdam* adam) {
      return guarded([&] { learner(engine).begin_update(*batch, *options, *adam); });
    },
    [](void* engine, float* logits, TorchLosses* losses) {
      return guarded([&] { *losses = learner(engine).end_update(logits); });
    },
    [](void* engine, const TorchArrays* arrays) { return guarded([&] { learner(engine).give_back(*arrays); }); },
    [](void* engine, const TorchLayout* value, const TorchPpoArrays* arrays) {
      return guarded([&] { learner(engine).take_ppo(*value, *arrays); });
    },
    [](void* engine, const TorchPpoBatch* batch, const TorchPpoOptions* options, TorchPpoLosses* losses) {
      return guarded([&] { *losses = learner(engine).update_ppo(*batch, *options); });
    },
    [](void* engine, const TorchPpoArrays* arrays) { return guarded([&] { learner(engine).give_back_ppo(*arrays); }); },
    [](void* engine, const float* parameters, const float* statistics) {
      return guarded([&] { learner(engine).prepare_inference(parameters, statistics); });
    },
    [](void* engine, int unit, int size, const uint8_t* observations, const int* env, const int* task, float* logits,
       float* psi) {
      return guarded([&] { learner(engine).infer(unit, size, observations, env, task, logits, psi); });
    }};

}  // namespace
}  // namespace synpo

extern "C" __attribute__((visibility("default"))) const synpo::TorchApi* synpo_torch_api() { return &synpo::kApi; }
