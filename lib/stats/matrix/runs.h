// A success matrix sorted into methods, runs and pairs, and the measures that can be taken of a pair.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/matrix.h"

namespace synpo {

// Counts and sums over episodes.
struct Tally {
  int64_t episodes = 0, successes = 0, wrong = 0, timeouts = 0, length = 0;
  double reward = 0;
  // Episodes of rows that say nothing of how they failed, how long they took, what they earned.
  int64_t unknown_failures = 0, unknown_lengths = 0, unknown_rewards = 0;
  void add(const Tally& other);
  void add(const MatrixRow& row);
};

struct PairTally {
  std::string env, task;
  Standing standing;
  std::string part;
  Tally tally;
  std::string name() const { return env + '\t' + task; }
};

struct Run {
  uint64_t seed;
  int64_t updates;
  std::vector<PairTally> pairs;  // each once
};

// The runs of one method in one world with one window, acting at one temperature.
struct Group {
  std::string world, method;
  int64_t window;
  std::optional<double> temperature;
  bool parts;  // some of its rows name one
  std::vector<Run> runs;
  std::vector<uint64_t> seeds() const;
  std::pair<int64_t, int64_t> updates() const;  // the fewest and the most of a run
};

// Groups in the order of their first row, and so with runs and pairs. Rows are taken as they are: merge_matrices first
// keeps double counting out.
std::vector<Group> group_runs(const Matrix& matrix);

// "synpo on gridworld, window 1, 20000 updates, temperature 0.5: 3 runs (seeds 1 2 3)"
std::string heading(const Group& group);

// An environment whose hash is not the same in all rows that say it: other ones go by its name. "" where there is none.
std::string mixed_environment(const Matrix& matrix);
std::string mixed_environment(const std::vector<const MatrixRow*>& rows);

// The subsets of pairs that have a name: seen, unseen, new, all, P, Q, rest.
const std::vector<std::string>& subset_names();
bool is_subset(const std::string& name);
bool belongs(Standing standing, const std::string& part, const std::string& subset);
bool belongs(const PairTally& pair, const std::string& subset);

// Something per episode. NaN where the matrix does not say it of all of them: a column missing in one made by hand is 0
// throughout.
struct MeasureKind {
  const char* name;
  double (*value)(const Tally&);
  bool rate;                       // of k in n; shown in per cent
  int digits;                      // after the point, as shown
  int64_t (*count)(const Tally&);  // k of a rate
  double scale() const { return rate ? 100 : 1; }
};
// success, reward, length, wrong, timeouts
const std::vector<MeasureKind>& measure_kinds();
// Throws std::invalid_argument for another name.
const MeasureKind& find_measure(std::string_view name);

}  // namespace synpo
