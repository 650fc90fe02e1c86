// Two sets of runs compared pair by pair, on start states that both of them were given.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files/io.h"
#include "format/matrix.h"
#include "stats/interval.h"
#include "stats/matrix/merge.h"

namespace synpo {

struct PairChange {
  std::string env, task;
  std::optional<Standing> standing;            // none where it is not the same for all runs
  int64_t k_a = 0, n_a = 0, k_b = 0, n_b = 0;  // successes in episodes, over the runs
  Interval interval;                           // Newcombe's, 95 %, for rate_b - rate_a
  double rate_a() const { return double(k_a) / double(n_a); }
  double rate_b() const { return double(k_b) / double(n_b); }
  double change() const { return rate_b() - rate_a(); }
};

struct SubsetChange {
  std::string name;  // as in a summary; only subsets that have pairs
  int64_t pairs = 0, better = 0, alike = 0, worse = 0;
  int64_t k_a = 0, n_a = 0, k_b = 0, n_b = 0;  // successes in episodes, over pairs and runs
  double mean_a, mean_b;                       // over pairs, every pair alike, of the mean over runs
  double change;                               // mean_b - mean_a
  Interval interval;                           // 95 %, for other runs, environments, tasks and episodes
};

// How many were left out for one reason: pairs with nothing left, and rows of the pairs that stay.
struct LeftOut {
  int64_t pairs = 0, rows = 0;
};

struct Comparison {
  std::string heading_a, heading_b;
  std::optional<double> temperature_a, temperature_b;
  size_t runs_a, runs_b;
  bool matched;  // both sides have the same seeds, each once: runs of one seed belong together
  bool many_envs, many_tasks;
  std::vector<SubsetChange> subsets;
  std::vector<PairChange>
      pairs;  // each once; largest change first, whichever its sign; then in the order of the matrix
  LeftOut only_one, other_env, new_to_one, other_seen, other_starts;
  int64_t lost_runs = 0;  // of which nothing could be compared
};

// Rows with the same eval_seed, environment, task and range of episodes began in the same states where both worlds have
// the same environments in the same order. Parts may stand in one of the two alone; different ones are kData. A pair is
// compared on those of its rows whose range both sides have, or on all of them with `any_start`; what is seen, unseen
// or new on one side is compared with the same on the other, and an environment with another hash not at all. Both must
// be merged, of one method and temperature each and of one world together; kData otherwise, or when no pair is left
// (kOtherStarts where `any_start` might leave some).
//
// The interval of a subset: mean_b - mean_a +- sqrt(r + p). r is that of the runs: t^2 times the variance of the mean
// of matched runs' differences; else of the difference of two means, as Welch (1947) has it, a side with one run being
// taken to vary as the other does; 0 with one run each. p is that of the pairs: t^2 times their variance with the pairs
// of one environment, and of one task, varying together (Cameron, Gelbach and Miller 2011). It holds Newcombe's of all
// episodes. Neither the order of the rows nor that of the runs counts.
constexpr Cause kOtherStarts{"other start states"};
Comparison compare(const MatrixSource& a, const MatrixSource& b, bool any_start);

// With the `most` pairs that changed most.
std::string comparison_text(const Comparison& comparison, size_t most);
// A row per subset, then a row per pair.
void write_comparison(Output& output, const Comparison& comparison);

}  // namespace synpo
