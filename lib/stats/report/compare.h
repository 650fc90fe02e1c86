// Two sets of runs compared pair by pair, on start states that both of them were given.
#pragma once
#include <string>
#include <vector>

#include "base/files/io.h"
#include "stats/bootstrap.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/runs.h"

namespace synpo {

struct PairChange {
  std::string env, task;
  bool seen;
  std::string part;
  int64_t k_a = 0, n_a = 0, k_b = 0, n_b = 0;  // successes in episodes, over the runs
  Interval interval;                           // Newcombe's, 95 %, for rate_b - rate_a
  double rate_a() const { return double(k_a) / double(n_a); }
  double rate_b() const { return double(k_b) / double(n_b); }
  double change() const { return rate_b() - rate_a(); }
};

struct SubsetChange {
  std::string name;  // as in a summary; only subsets that have pairs
  int64_t pairs = 0, better = 0, alike = 0, worse = 0;
  double mean_a, mean_b;  // over pairs, every pair alike, of the mean over runs
  double change;          // mean_b - mean_a
  Interval interval;      // 95 %, bootstrap over runs and pairs; NaN where nothing varies
};

struct Comparison {
  std::string heading_a, heading_b;
  size_t runs_a, runs_b;
  bool matched;  // both sides have the same seeds, each once: runs are drawn together
  std::vector<SubsetChange> subsets;
  std::vector<PairChange> pairs;  // largest change first, whichever its sign; then in the order of the matrix
  int64_t only_one = 0, other_seen = 0, other_starts = 0;  // pairs left out, and why
  int64_t lost_runs = 0;                                   // of which nothing could be compared
  BootstrapPlan plan;
};

// Rows with the same eval_seed, environment, task and range of episodes began in the same states where both worlds have
// the same environments in the same order. Parts may stand in one of the two alone; different ones are kData. A pair is
// compared on those of its rows whose range both sides have, or on all of them with `any_start`; a pair that is seen on
// one side and unseen on the other is left out. Both must be merged, of one method each and of one world together;
// kData otherwise, or when no pair is left.
Comparison compare(const MatrixSource& a, const MatrixSource& b, bool any_start, const BootstrapPlan& plan);

// With the `most` pairs that changed most.
std::string comparison_text(const Comparison& comparison, size_t most);
// A row per subset, then a row per pair.
void write_comparison(Output& output, const Comparison& comparison);

}  // namespace synpo
