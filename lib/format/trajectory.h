// Trajectories: JSON Lines, one episode a line, each line whole in itself (synpo-trajectory(5)).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files/io.h"

namespace synpo {

constexpr int kTrajectoryVersion = 1;
constexpr int kMostActions = 256;  // of any world

// What a policy thought of every action at every step.
struct StepScores {
  int actions = 0;                    // of the world
  double temperature = 0;             // that actions were drawn with, 0: the best one was taken
  std::vector<float> scores;          // [steps, actions]
  std::vector<double> probabilities;  // of being taken, [steps, actions]
};

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
  StepScores policy;  // empty where it is not recorded, and in all that is read
};

// One line, without the newline. Scores read back as the same floats and probabilities as the same doubles.
std::string format_trajectory(const Trajectory& trajectory);

// Throws kData with what was found and what was expected (the caller adds the line). Unknown fields are passed over.
// Lengths must agree; actions are below kMostActions, there are at most `step_limit` steps and at least one. Whether a
// world has them, replay() knows (play/episode.h).
Trajectory parse_trajectory(const std::string& line, int step_limit);

// The line, without the newline, that says at the end of a stream how many trajectories it has.
std::string format_end(uint64_t trajectories);

// A stream does not say its end, as it should.
constexpr Cause kNoEnd{"a stream that does not say its end"};

// The lines of a stream that hold trajectories. Lines that say the end are passed over; a stream of several with an end
// each, one after the other or mixed, has the sum of what these say.
class TrajectoryLines {
 public:
  explicit TrajectoryLines(Input& input) : input_(input) {}

  // The next one; false at the end of the stream. Throws kData there for a stream that says that it has more or fewer,
  // and for a malformed end, with its line.
  bool next(std::string& line);
  uint64_t count() const { return count_; }  // of trajectories so far
  // At the end of the stream: throws kData (kNoEnd) where it did not say its end.
  void check_end() const;

 private:
  bool is_end(const std::string& line);
  Input& input_;
  uint64_t count_ = 0, said_ = 0, ends_ = 0;
};

}  // namespace synpo
