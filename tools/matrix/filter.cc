// synpo-matrix filter: some of the rows.
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "format/matrix.h"
#include "format/pairs.h"
#include "matrix/matrix.h"
#include "stats/matrix/filter.h"
#include "stats/matrix/merge.h"
#include "stats/matrix/split.h"

namespace synpo {
namespace {

// For an option that may name several: each goes into the set.
auto names_into(std::set<std::string>& names) {
  return [&names](const std::string& list) {
    for (const std::string& name : split_names(list)) names.insert(name);
  };
}

void add_seeds(const std::string& list, std::set<uint64_t>& seeds) {
  for (const std::string& text : split_names(list)) {
    const int64_t value = parse_count(text);
    if (value < 0) throw std::invalid_argument("expected whole numbers, at least 0");
    seeds.insert(uint64_t(value));
  }
}

void add_temperatures(const std::string& list, std::set<double>& temperatures) {
  for (const std::string& text : split_names(list)) {
    double value = -1;
    if (!parse_whole(text, value) || !(value >= 0)) throw std::invalid_argument("expected numbers, at least 0");
    temperatures.insert(value);
  }
}

// Adds the pairs of a file. Unlike a name that was typed, a pair of a file need not be in this matrix.
void add_pairs_of(const std::string& path, const Matrix& matrix, std::set<std::pair<std::string, std::string>>& pairs) {
  std::set<std::pair<std::string, std::string>> there;
  for (const MatrixRow& row : matrix.rows) there.emplace(row.env, row.task);
  Input input(path);
  for (const PairRow& pair : read_pairs(input))
    if (there.contains({pair.env, pair.task})) pairs.emplace(pair.env, pair.task);
  if (pairs.empty()) fail(Exit::kData, input.name(), ": none of its pairs is in the matrix");
}

}  // namespace

int matrix_filter(int argc, char** argv) {
  RowFilter filter;
  std::string pairs_path, output_path = "-";
  bool seen = false, unseen = false, fresh = false;
  Options options("synpo-matrix filter", "[OPTION]... [MATRIX]... > MATRIX", "The rows that fit all of the options.");
  options.call('e', "env", "LIST", "of these environments", names_into(filter.envs))
      .call('t', "task", "LIST", "of these tasks", names_into(filter.tasks))
      .call(0, "pair", "ENV,TASK", "of this pair; may be repeated",
            [&](const std::string& text) { filter.pairs.insert(split_pair_name(text)); })
      .text('p', "pairs", "PAIRS", "of the pairs in this file", pairs_path)
      .flag(0, "seen", "of seen pairs", seen)
      .flag(0, "unseen", "of unseen pairs", unseen)
      .flag(0, "new", "of pairs whose environment or task is new to training", fresh)
      .call(0, "part", "LIST", "of these parts, as in P or P,Q", names_into(filter.parts))
      .call('m', "method", "LIST", "of these methods", names_into(filter.methods))
      .call(0, "run-seed", "LIST", "of runs with these seeds",
            [&](const std::string& list) { add_seeds(list, filter.seeds); })
      .call(0, "temperature", "LIST", "of runs that acted at these temperatures",
            [&](const std::string& list) { add_temperatures(list, filter.temperatures); })
      .flag(0, "not", "the other rows instead: those that do not fit", filter.inverted)
      .text('o', "output", "FILE", "where the matrix goes", output_path);
  const std::vector<std::string> files = options.parse(argc, argv, 0, kMostFiles);
  if (seen + unseen + fresh > 1) fail(Exit::kUsage, "give either --seen or --unseen or --new");
  if (seen) filter.standings = {Standing::kSeen};
  if (unseen) filter.standings = {Standing::kUnseen};
  if (fresh) filter.standings = {Standing::kNew};
  const Matrix matrix = read_matrices(files);
  if (options.given("pairs")) add_pairs_of(pairs_path, matrix, filter.pairs);
  const Matrix left = filter_rows(matrix, filter);
  Output output(output_path);
  write_matrix(output, left);
  output.finish();
  return 0;
}

}  // namespace synpo
