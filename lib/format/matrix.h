// Success matrices: TSV, a row per (run, pair) with counts, so that shards merge exactly; rates are derived.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/files/io.h"

namespace synpo {

struct MatrixRow {
  std::string run;    // hash of the checkpoint's weights, 16 hexadecimal digits
  std::string world;  // "gridworld"
  int64_t window = 1;
  std::string method;  // "synpo"
  uint64_t seed = 0;   // the run's
  int64_t updates = 0;
  uint64_t eval_seed = 0;
  int64_t first_episode = 0;  // episodes first_episode .. first_episode + episodes - 1 of this pair were run
  std::string env, task;
  bool seen = false;
  int64_t episodes = 0, successes = 0, wrong = 0, timeouts = 0;
  double reward = 0;  // sums over the episodes
  int64_t length = 0;
  std::string part;  // empty where the file has no such column

  // Whether anybody took these numbers: no episode is without a step, and one that failed ended in some way.
  bool knows_failures() const { return wrong > 0 || timeouts > 0 || successes == episodes; }
  bool knows_length() const { return length > 0; }
  bool knows_reward() const { return length > 0 || reward != 0; }

  std::vector<std::string> extra;  // fields of the columns that this build does not know, as they came
};

struct Matrix {
  std::vector<MatrixRow> rows;
  bool has_part = false;
  std::vector<std::string> extra_columns;
};

// Names the run of a row: its hash or, where a hand-made matrix has none, world, window, method, seed and updates
// together.
std::string run_key(const MatrixRow& row);

// Only env, task, episodes, successes must be there (a hand-made matrix); what is missing takes the values above, and
// `seen` then 0. Throws kData for a missing column, counts that are negative or do not fit together
// (successes + wrong + timeouts > episodes; no episode), a repeated row (run_key, eval_seed, env, task, first_episode),
// NaN, invalid UTF-8, no row, or more than a million rows. Row i of the result stood in line i + 2.
Matrix read_matrix(Input& input);
void write_matrix(Output& output, const Matrix& matrix);

}  // namespace synpo
