// Counter-based random numbers (Philox 4x32, ten rounds; Salmon et al. 2011).
// A stream is named by what it is for, so that results depend neither on threads nor on the order of work.
#pragma once
#include <array>
#include <cstdint>

namespace synpo {

// The use of a stream of random numbers; two purposes never share numbers. The values decide what is drawn: a new
// purpose goes to the end.
enum class Purpose : uint32_t {
  kPairOrder = 1,
  kEpisodeStart,  // of the expert's episodes
  kNoise,         // in the expert's moves
  kSplit,
  kInit,  // first weights; also the plans of the built-in kitchens, and the colours of kitchens
  kBatch,
  kRollIn,
  kEvaluation,       // starts of synpo-eval's episodes; their moves are of kSample
  kEvaluationPairs,  // of the evaluations within a run
  kBootstrap,
  kDropout,
  kOwnMove,
  kSample,
  kActor,  // starts of PPO's episodes; their moves are of kActorMove
  kLayout,
  kRunEvaluation,  // starts of the evaluations within a run
  kRunEvaluationMove,
  kTrainingStart,  // of episodes that a policy plays to learn from
  kTrainingMove,
  kActorMove,
  kStatisticsMove,
  kRolloutOrder
};

class Random {
 public:
  // The stream of (seed, purpose, a, b): for instance (seed, kEpisodeStart, pair, episode). a is taken modulo 2^32.
  Random(uint64_t seed, Purpose purpose, uint64_t a = 0, uint64_t b = 0);

  uint32_t next();
  // Uniform in [0, n), without modulo bias. n > 0.
  uint32_t below(uint32_t n);
  // Uniform in [0, 1) with 32 bits.
  double uniform();
  // Standard normal (Box-Muller; both halves are used).
  double normal();

 private:
  std::array<uint32_t, 2> key_;
  std::array<uint32_t, 4> counter_;
  std::array<uint32_t, 4> block_;
  int used_ = 4;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace synpo
