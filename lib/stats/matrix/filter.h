// Some of a matrix's rows, and a matrix laid out as one: tasks down, environments across.
#pragma once
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/files/io.h"
#include "format/matrix.h"

namespace synpo {

// A row is kept when it fits everything that is named; an empty set fits all.
struct RowFilter {
  std::set<std::string> envs, tasks, methods, parts;
  std::set<std::pair<std::string, std::string>> pairs;  // (env, task)
  std::set<uint64_t> seeds;
  std::set<double> temperatures;
  std::set<Standing> standings;
  bool inverted = false;  // keeps the rows that do not fit
  bool fits(const MatrixRow& row) const;
};

// Throws kData when a name of the filter is nowhere in the matrix, which would be a misspelling, or when no row is
// left.
Matrix filter_rows(const Matrix& matrix, const RowFilter& filter);

// A column `task`, then a column per environment, in the orders given; the value of each pair over all runs together,
// NA where a pair has no value. `measure` is one of measure_kinds(), or episodes, successes, seen.
bool is_wide_measure(const std::string& name);
void write_wide(Output& output, const Matrix& matrix, const std::vector<std::string>& envs,
                const std::vector<std::string>& tasks, const std::string& measure);

}  // namespace synpo
