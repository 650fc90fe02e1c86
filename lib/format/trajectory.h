// Trajectories: JSON Lines, one episode a line, each line whole in itself (synpo-trajectory(5)).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace synpo {

constexpr int kTrajectoryVersion = 1;
constexpr int kMostActions = 256;  // of any world

struct Trajectory {
  std::string world = "gridworld";
  int rules = 1;          // version of the world's rules
  std::string env, task;  // names
  uint64_t env_hash = 0;  // of the environment's canonical content
  int window = 1;         // what the agent saw
  uint64_t seed = 0;
  int64_t episode = 0;                               // of this seed and pair
  std::map<std::string, std::pair<int, int>> start;  // "agent" and objects: row, column
  std::vector<uint8_t> actions;
  std::vector<uint8_t> labels;    // the expert's action at every step; empty: the same as `actions`
  std::vector<int> reward_cents;  // a step's reward in hundredths
  bool success = false, terminated = false, truncated = false;
};

// One line, without the newline.
std::string format_trajectory(const Trajectory& trajectory);

// Throws kData with what was found and what was expected (the caller adds the line). Unknown fields are passed over.
// Lengths must agree; actions are below kMostActions, there are at most `step_limit` steps and at least one. Whether a
// world has them, replay() knows (play/episode.h).
Trajectory parse_trajectory(const std::string& line, int step_limit);

}  // namespace synpo
