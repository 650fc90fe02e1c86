// Success of a policy on pairs, every episode run to its own end.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "format/matrix.h"
#include "format/pairs.h"
#include "format/run_log.h"
#include "format/trajectory.h"
#include "play/model.h"
#include "play/running_episode.h"
#include "policy/policy.h"
#include "world/world.h"

namespace synpo {

// An episode to run: start state from (seed, the purpose of its starts, pair, number).
struct EvalEpisode {
  int pair;  // position in the list of pairs
  int64_t number;
};

// Episodes to run, each made when it is due: so many of them that no list could hold them, perhaps.
struct EpisodePlan {
  int64_t count;
  std::function<EvalEpisode(int64_t position)> at;  // called from any thread
};
EpisodePlan listed(std::vector<EvalEpisode> episodes);

// What episodes are played for: each use has starts and moves of its own, so that none is tested on what another one
// learned from or chose by.
struct EpisodeUse {
  Purpose starts, moves;
};
constexpr EpisodeUse kForMatrix = {Purpose::kEvaluation, Purpose::kSample};
constexpr EpisodeUse kForRunLog = {Purpose::kRunEvaluation, Purpose::kRunEvaluationMove};
constexpr EpisodeUse kForTraining = {Purpose::kTrainingStart, Purpose::kTrainingMove};

struct EvalOptions {
  uint64_t seed = 1;
  int window = 1;
  double temperature = 0;  // actions are drawn from softmax(scores / temperature); 0: the best one
  EpisodeUse use = kForMatrix;
  bool scores = false;  // trajectories have the policy's scores and probabilities
};

// Called with every episode in the order of the plan, one at a time, from any thread.
using EpisodeSink = std::function<void(const Trajectory&)>;

// Runs the episodes with the policy's parameters as prepared by prepare_inference(pairs). Results are per pair, in the
// order of `pairs`; neither threads nor what else is in the plan changes an episode. Memory does not grow with their
// number.
std::vector<Outcomes> evaluate(Parallel& parallel, Engine& engine, const World& world,
                               const std::vector<EnvTask>& pairs, const EpisodePlan& plan, const EvalOptions& options,
                               const EpisodeSink& sink = nullptr,
                               const std::function<void(size_t done)>& progress = nullptr);

// Episodes first .. first + count - 1 of every pair.
struct MatrixPlan {
  std::vector<PairRow> pairs;
  int64_t count = 100, first = 0;
  uint64_t seed = 1;
  double temperature = 0;
  std::string pairs_file = "";  // that names the pairs, for messages
  EpisodeUse use = kForMatrix;
  bool scores = false;  // as in EvalOptions
};

// The success matrix of a policy, a row for each pair in their order; `run` names its weights.
Matrix success_matrix(Parallel& parallel, const World& world, Model& model, const std::string& run,
                      const MatrixPlan& plan, const EpisodeSink& sink = nullptr,
                      const std::function<void(size_t done)>& progress = nullptr);

// Success and mean return, at the policy's own temperature, on `episodes` seen and as many unseen pairs drawn at
// random, an episode each (kForRunLog); the same ones at every call while no pair is seen that was not. Unseen are
// pairs of an environment and a task that other seen pairs have. NaN where there are no such pairs. The weights are
// given apart: a run may evaluate others than those it learns with.
RunLogRow::Evaluation evaluate_sample(Parallel& parallel, const World& world, const Model& model,
                                      const float* parameters, const float* statistics, int episodes);

}  // namespace synpo
