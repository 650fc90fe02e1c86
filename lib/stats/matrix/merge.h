// Matrices of shards and seeds put together, every episode counted once.
#pragma once
#include <string>
#include <vector>

#include "format/matrix.h"

namespace synpo {

struct MatrixSource {
  std::string name;  // for messages
  Matrix matrix;     // as read: row i stood in line i + 2
};

// One matrix of all rows. Within a run, eval_seed and pair, rows whose episodes follow one another are added up, rows
// with a gap between them, with different values in unknown columns, or of which one says what the other does not
// (MatrixRow) stay apart, and so do rows whose sums would be more than is read (kMatrixCount, kMatrixReward); rows that
// share an episode are refused (kData, both places named). Runs of one training that disagree about world, window,
// method, seed or updates, about an environment's hash, or about seen or part of a pair, are refused as well. What a
// source does not say of an environment's hash, or of whether a pair is new, is taken from those that do. Pairs keep
// the order of their first appearance; a pair's rows are sorted by eval_seed and first episode, so the sums do not
// depend on the order of the sources. Unknown columns are united; a source without one has empty fields there.
Matrix merge_matrices(std::vector<MatrixSource> sources);

// The matrices of these files (none: standard input), merged. With `or_pairs` a file of pairs may stand there alone, as
// read_matrix() reads it; beside other files it is kData.
Matrix read_matrices(std::vector<std::string> files, bool or_pairs = false);

// a + b, exactly where both are whole hundredths, as GridWorld's rewards are.
double add_rewards(double a, double b);

// sum += other, for whatever holds the counts of episodes: rows of a matrix and tallies of them.
template <class Sum, class Counts>
void add_counts(Sum& sum, const Counts& other) {
  sum.episodes += other.episodes;
  sum.successes += other.successes;
  sum.wrong += other.wrong;
  sum.timeouts += other.timeouts;
  sum.length += other.length;
  sum.reward = add_rewards(sum.reward, other.reward);
}

}  // namespace synpo
