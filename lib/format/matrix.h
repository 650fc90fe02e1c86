// Success matrices: TSV, a row per (run, pair) with counts, so that shards merge exactly; rates are derived.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files/io.h"

namespace synpo {

// The bounds of what is read: a matrix that is written keeps to them.
constexpr size_t kMatrixRows = 1000000;
constexpr size_t kMatrixExtraFields = 16000000;
// Small enough that sums over kMatrixRows rows stay within 64 bits.
constexpr int64_t kMatrixCount = 1000000000000;
constexpr double kMatrixReward = 1e15;

// How a pair stands to training, which saw the pair itself, or its environment and its task in other pairs alone, or
// not even those.
enum class Standing { kSeen, kUnseen, kNew };
const char* name_of(Standing standing);  // seen, unseen, new

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
  bool seen = false, is_new = false;  // never both
  int64_t episodes = 0, successes = 0, wrong = 0, timeouts = 0;
  double reward = 0;  // sums over the episodes; the reward is NaN where the file does not say it
  int64_t length = 0;
  std::string part;                   // empty where the file has no such column
  std::optional<double> temperature;  // what actions were drawn with, where the file says it
  std::string env_hash;               // of the environment's content, 16 hexadecimal digits; empty where not said

  Standing standing() const { return seen ? Standing::kSeen : is_new ? Standing::kNew : Standing::kUnseen; }

  // Whether anybody took these numbers: no episode is without a step, and one that failed ended in some way.
  bool knows_failures() const { return wrong > 0 || timeouts > 0 || successes == episodes; }
  bool knows_length() const { return length > 0; }
  bool knows_reward() const { return !std::isnan(reward) && (length > 0 || reward != 0); }

  std::vector<std::string> extra;  // fields of the columns that this build does not know, as they came
};

struct Matrix {
  std::vector<MatrixRow> rows;
  bool has_part = false;
  std::vector<std::string> extra_columns;
};

// Names what was trained: the hash of a row or, where a hand-made matrix has none, world, window, method, seed and
// updates together.
std::string training_key(const MatrixRow& row);
// Names the run of a row: what was trained, and the temperature at which it acted.
std::string run_key(const MatrixRow& row);

// Only env, task, episodes, successes must be there (a hand-made matrix); what is missing takes the values above, and
// `seen` then 0. Throws kData for a missing column, counts that are negative or do not fit together
// (successes + wrong + timeouts > episodes; no episode), a pair both seen and new, a repeated row (run_key, eval_seed,
// env, task, first_episode), NaN, invalid UTF-8, no row, or more than kMatrixRows. Row i of the result stood in line
// i + 2.
//
// With `or_pairs` a file of pairs that says which are seen (pairs.h) is read too: rows without an episode.
Matrix read_matrix(Input& input, bool or_pairs = false);
// `reward`, `temperature`, `new` and `env_hash` are columns where a row has something to say there. Throws kData for
// more rows, columns or fields than are read.
void write_matrix(Output& output, const Matrix& matrix);

}  // namespace synpo
