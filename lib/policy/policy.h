// The face that every method shows to the learner and the evaluator: parameters in one flat array, a training step, and
// inference.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "nn/layout.h"
#include "policy/embedding_loss.h"
#include "policy/losses.h"

namespace synpo {

struct InitOptions {
  uint64_t seed = 1;
  double embedding_sd = 0;  // embeddings are drawn from N(0, sd^2); 0: Xavier uniform
};

// How a training step learns from its batch.
struct StepOptions {
  LossWeights weights = {};
  double dropout = 0;      // ModuleNet: probability that a value at the seam is left out
  double discount = 0.99;  // SF: gamma
};

// A loss of the scores other than imitation's, for a batch of n states: psi [n, feature], logits and dlogits [n,
// actions]. Sets dlogits, may add to dpsi, and returns the loss.
template <class T>
class Objective {
 public:
  virtual ~Objective() = default;
  virtual double apply(Parallel& parallel, int n, const T* psi, const T* logits, T* dlogits, T* dpsi) = 0;
};

// Steps to learn from. Observations are [size, Encoder::observation_size()]; the others are [size].
template <class T>
struct StepBatch {
  int size = 0;
  const uint8_t* observations = nullptr;
  const int* env = nullptr;
  const int* task = nullptr;
  const int* label = nullptr;  // the expert's action: imitation, disentanglement
  const int* taken = nullptr;  // the action taken, whose reward is to be predicted
  const T* reward = nullptr;
  uint64_t seed = 0, update = 0;  // name the random numbers of this batch
  // For methods that ask for it. The place in the batch of the step after this one, or one of these.
  static constexpr int kTerminal = -1;  // nothing comes after it
  static constexpr int kUnknown = -2;   // it is not in the batch
  const int* next = nullptr;
  const T* planner_q = nullptr;       // [size, actions], undiscounted return of each action under the planner
  Objective<T>* objective = nullptr;  // instead of imitation's loss
  bool frozen_statistics = false;     // normalisation by the running statistics, which then stay
  const T* psi =
      nullptr;  // [size, feature], instead of observations; the encoder then is left alone, and its gradient as it was
};

// A method may want more of a batch than the steps themselves.
struct BatchNeeds {
  bool next = false, planner_q = false;
};

// The temperature that a policy acts at where nothing else is said: with the best action alone, one that has learned
// most of its moves still walks in circles where it has not.
constexpr double kTemperature = 0.5;

// The two sides of a pair, which have embeddings.
enum class PairSide { kEnv, kTask };

// The parameters of a method serve one of these ends.
enum class ParameterGroup {
  kEncoder,       // makes psi of what is seen
  kEmbeddings,    // of environments and tasks
  kRecognisers,   // f_env and f_task
  kCoefficients,  // alpha and beta
  kHeads          // makes scores and rewards
};

template <class T>
class Policy {
 public:
  virtual ~Policy() = default;
  const Layout& parameters() const { return parameters_; }
  const Layout& statistics() const { return statistics_; }  // running statistics of batch normalisation
  // The table of embeddings [environments, or tasks; width]; nullptr where the method has none.
  const TensorInfo* embeddings(PairSide side) const;
  std::vector<const TensorInfo*> group(ParameterGroup group) const;
  // The loss of the embeddings of these environments and tasks and, where asked for, of the recognisers, everything
  // else taken as it is in `parameters`; and how many bytes it keeps of a step. nullptr and 0 where the method has
  // none.
  virtual std::unique_ptr<EmbeddingLoss> embedding_loss(const T* parameters, const std::vector<bool>& new_env,
                                                        const std::vector<bool>& new_task, bool recognisers) const;
  virtual size_t embedding_loss_step_bytes() const { return 0; }

  virtual size_t observation_size() const = 0;  // bytes of a state
  virtual BatchNeeds needs() const { return {}; }
  // What values inside the method are multiplied with in a training step, drawn for its batch: [size, n]. Empty for
  // methods that leave nothing out.
  virtual std::vector<T> dropout_factors(const StepBatch<T>&, const StepOptions&) const { return {}; }
  // See kTemperature; 0 where scores are values, whose best action is taken.
  virtual double temperature() const { return kTemperature; }

  virtual void initialise(const InitOptions& options, T* parameters, T* statistics) const = 0;

  // Forward and backward on a batch. `gradient` is overwritten; `logits` [size, actions] receives the policy's scores.
  // Running statistics move. Bits do not depend on the number of threads.
  virtual Losses step(Parallel& parallel, const StepBatch<T>& batch, const StepOptions& options, const T* parameters,
                      T* statistics, T* gradient, T* logits) = 0;

  // Takes over parameters for infer(). `pairs` are the (env, task) that will be asked for, numbered as they come.
  virtual void prepare_inference(Parallel& parallel, const T* parameters, const T* statistics,
                                 const std::vector<std::pair<int, int>>& pairs) = 0;
  // Scores [size, actions] of states, state i of pair number pair[i], with frozen statistics. One thread's part:
  // `thread` picks its scratch memory. At most kInferenceUnit states.
  static constexpr int kInferenceUnit = 64;
  // psi [size, feature] is given where asked for.
  virtual void infer(int thread, int size, const uint8_t* observations, const int* pair, T* logits,
                     T* psi = nullptr) = 0;

 protected:
  // The method's own groups: how the names of their tensors begin.
  struct OwnGroup {
    ParameterGroup group;
    std::vector<std::string> beginnings;
  };
  virtual std::vector<OwnGroup> own_groups() const { return {}; }

  Layout parameters_, statistics_;
};

extern template class Policy<float>;
extern template class Policy<double>;

}  // namespace synpo
