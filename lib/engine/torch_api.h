// What passes between synpo and its plug-in of LibTorch (lib/torch): plain types and functions alone, so that the two
// may be built against different C++ standard libraries.
//
// Every function returns 0, or 1 after an error, which last_error() then tells.
#pragma once
#include <cstddef>
#include <cstdint>

namespace synpo {

constexpr int kTorchApiVersion = 2;

// A tensor of the policy's layout (nn/layout.h): its place in the flat array.
struct TorchTensor {
  const char* name;
  const int* shape;
  int rank;
  size_t offset, size;
};

struct TorchLayout {
  const TorchTensor* tensors;
  int count;
  size_t total;  // values of the flat array
};

// How the products are computed: in float32; with factors rounded to TF32 (10 bits); the encoder in bfloat16.
enum class TorchPrecision { kFloat32, kTf32, kBf16 };

// A policy's sizes (policy/policy_shape.h) and where it is to be computed.
struct TorchConfig {
  const char* method;
  const char* device;  // as LibTorch names it: "cpu", "cuda:0"
  TorchPrecision precision;
  bool graphs;  // on CUDA, updates and scores are captured once and replayed
  int threads;  // of the CPU
  // What an observation is. Pictures: [side, side, history] colours of a palette [colours, 3]; features: floats.
  bool features;
  int side, history, colours;
  const uint8_t* palette;
  int view, objects, object_floats;
  int envs, tasks, actions;
  int feature, basis, embedding, action_embedding, seam;
  int sf_loss;  // 0: temporal differences, 1: the planner's Q, 2: cross-entropy
  bool normalise_input, normalise_embeddings;
  TorchLayout parameters, statistics;
};

// A batch as StepBatch (policy/policy.h) says, in the computer's memory.
struct TorchBatch {
  int size;
  const uint8_t* observations;  // null: psi is given
  const float* psi;
  const int *env, *task, *label, *taken, *next;
  const float *reward, *planner_q;
  const float* keep;  // [size, seam]: factors at ModuleNet's seam
  bool frozen_statistics;
};

struct TorchStepOptions {
  double reward, env, task;  // weights of losses
  double discount;
};

// policy, reward, env, task; NaN where the method has no such loss.
struct TorchLosses {
  double values[4];
};

struct TorchAdam {
  double learning_rate, beta1, beta2, epsilon, weight_decay;
  int64_t step;
  double keep;
};

// A minibatch of PPO, as PpoBatch (engine/engine.h); its statistics are frozen.
struct TorchPpoBatch {
  TorchBatch steps;
  const float *log_probability, *advantage, *target;
};

struct TorchRmsProp {
  double learning_rate, smoothing, epsilon, weight_decay;
};

struct TorchPpoOptions {
  TorchStepOptions auxiliary;
  double clip, entropy, value_weight, gradient_norm;
  TorchRmsProp policy, value;
};

// As PpoLosses.
struct TorchPpoLosses {
  double policy, entropy, kl, clip_fraction, largest_ratio, smallest_ratio, value, total;
};

struct TorchPpoArrays {
  float *parameters, *statistics, *mean_squares, *value_parameters, *value_mean_squares;
};

struct TorchArrays {
  float *parameters, *statistics, *first_moment, *second_moment, *average, *average_statistics;
};

struct TorchApi {
  int version;
  const char* (*last_error)();
  // The device that is computed on, in words, and LibTorch's version.
  const char* (*describe)(void* engine);
  int (*create)(const TorchConfig* config, void** engine);
  void (*destroy)(void* engine);
  int (*step)(void* engine, const TorchBatch* batch, const TorchStepOptions* options, const float* parameters,
              float* statistics, float* gradient, float* logits, TorchLosses* losses);
  int (*take)(void* engine, const TorchArrays* arrays);
  int (*begin_update)(void* engine, const TorchBatch* batch, const TorchStepOptions* options, const TorchAdam* adam);
  int (*end_update)(void* engine, float* logits, TorchLosses* losses);
  int (*give_back)(void* engine, const TorchArrays* arrays);
  // PPO: `value` is the layout of the value function's tensors, always the same.
  int (*take_ppo)(void* engine, const TorchLayout* value, const TorchPpoArrays* arrays);
  int (*update_ppo)(void* engine, const TorchPpoBatch* batch, const TorchPpoOptions* options, TorchPpoLosses* losses);
  int (*give_back_ppo)(void* engine, const TorchPpoArrays* arrays);
  int (*prepare_inference)(void* engine, const float* parameters, const float* statistics);
  // Scores of `size` states, at most `unit`; psi may be null.
  int (*infer)(void* engine, int unit, int size, const uint8_t* observations, const int* env, const int* task,
               float* logits, float* psi);
};

// The plug-in's one symbol.
constexpr char kTorchApiSymbol[] = "synpo_torch_api";
using TorchApiFunction = const TorchApi* (*)();

}  // namespace synpo
