// Rows of matrices for tests of what is counted from them.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "format/matrix.h"

namespace synpo {

// Of the task R-B; the run's seed is its last letter. What neither succeeded nor ended wrong timed out.
inline MatrixRow row(const std::string& run, const std::string& env, bool seen, int64_t first, int64_t episodes,
                     int64_t successes, int64_t wrong = 0, double reward = 0, int64_t length = 0) {
  MatrixRow r;
  r.run = run;
  r.world = "gridworld";
  r.method = "synpo";
  r.seed = uint64_t(run.back());
  r.env = env;
  r.task = "R-B";
  r.seen = seen;
  r.first_episode = first;
  r.episodes = episodes;
  r.successes = successes;
  r.wrong = wrong;
  r.timeouts = episodes - successes - wrong;
  r.reward = reward;
  r.length = length;
  return r;
}

// Of any pair, with successes alone.
inline MatrixRow row(const std::string& run, uint64_t seed, const std::string& env, const std::string& task, bool seen,
                     int64_t successes, int64_t episodes = 10, const std::string& method = "synpo") {
  MatrixRow r;
  r.run = run;
  r.world = "gridworld";
  r.method = method;
  r.seed = seed;
  r.env = env;
  r.task = task;
  r.seen = seen;
  r.episodes = episodes;
  r.successes = successes;
  return r;
}

inline Matrix matrix(std::vector<MatrixRow> rows) {
  Matrix m;
  m.rows = std::move(rows);
  return m;
}

}  // namespace synpo
