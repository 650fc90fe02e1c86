// Episodes between their file form (format/trajectory.h) and the world's.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "format/pairs.h"
#include "format/trajectory.h"
#include "world/world.h"

namespace synpo {

// A replayed trajectory: enough to see every one of its states again.
struct Episode {
  EnvTask pair;
  WorldState start;
  std::vector<uint8_t> actions;
  std::vector<uint8_t> labels;  // of the same length
};

// The expert's episode number `episode` of a pair. With probability `noise` a step is a random move instead of the
// expert's; labels stay the expert's.
Trajectory expert_episode(const World& world, EnvTask pair, uint64_t seed, int64_t episode, double noise, int window);

// The start of that episode: the same for expert and evaluation, from (seed, purpose, pair, episode) alone.
WorldState episode_start(const World& world, EnvTask pair, uint64_t seed, Purpose purpose, int64_t episode);

// Plays the trajectory again. Throws kData when env, task, rules or environment are not this world's (kOtherWorld for
// an environment), or rewards and end don't come out again.
constexpr Cause kOtherWorld{"an environment of another world"};
Episode replay(const World& world, const Trajectory& trajectory);

// The same trajectory with the expert's labels.
Trajectory relabelled(const World& world, const Trajectory& trajectory);

// An episode as it is played, step by step.
struct EpisodeRecord {
  EpisodeRecord() = default;
  EpisodeRecord(EnvTask pair, const WorldState& start) : episode{pair, start, {}, {}} {}
  void add(int label, int action, const WorldStep& step);

  Episode episode;
  std::vector<int> reward_cents;
  WorldStep last = {};
  StepScores policy;  // empty, or of every step
};
// Its file form, as number `number` of its pair and seed.
Trajectory to_trajectory(const World& world, const EpisodeRecord& record, uint64_t seed, int64_t number, int window);

// Pairs by name to pairs by position; rows with seen = 0 are left out where `seen_only`. Throws kData for an unknown
// name (kOtherWorld for an environment that no other resembles).
std::vector<EnvTask> resolve_pairs(const World& world, const std::vector<PairRow>& rows, bool seen_only,
                                   const std::string& file);

// All pairs of a world, environment by environment, as a file without a column seen = 1 would list them.
std::vector<PairRow> all_pairs(const World& world);
// The rows of a pairs file.
std::vector<PairRow> read_pairs(const std::string& path);
// Those of its pairs that have seen = 1. Throws kData where there is none.
std::vector<EnvTask> read_seen_pairs(const World& world, const std::string& path);

// The expert's stream: episodes of pairs drawn at random, or, where `per_pair` > 0, so many of every pair in order.
struct ExpertStream {
  std::vector<EnvTask> pairs;
  uint64_t seed = 1;
  int64_t per_pair = 0;
  double noise = 0;
  int window = 1;
  // Number `number` of them, from 0.
  Trajectory trajectory(const World& world, int64_t number) const;
};

}  // namespace synpo
