// The rows and the columns of a matrix: what a method does at each task, or in each environment, the worst first.
#pragma once
#include <string>
#include <vector>

#include "base/files/io.h"
#include "format/matrix.h"
#include "stats/matrix/runs.h"

namespace synpo {

enum class Axis { kTasks, kEnvs };  // tasks are a matrix's rows, environments its columns

struct Margin {
  std::string name;
  int64_t pairs = 0;                   // different ones over all runs
  Tally all, seen, unseen, new_pairs;  // over pairs and runs
  std::string worst;                   // the environment of the task's worst pair, or the other way round
  Tally worst_tally;
  double rate() const { return double(all.successes) / double(all.episodes); }
};

struct GroupMargins {
  Group group;
  std::vector<Margin> margins;  // lowest success first; then in the order of the matrix
};

// Throws kData where other environments go by one name.
std::vector<GroupMargins> margins(const Matrix& matrix, Axis axis);

// The `most` worst of each group.
std::string margins_text(const std::vector<GroupMargins>& groups, Axis axis, size_t most);
void write_margins(Output& output, const std::vector<GroupMargins>& groups, Axis axis, size_t most);

}  // namespace synpo
