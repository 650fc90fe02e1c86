// Pairs files: TSV with columns env, task and, optionally, seen (0 or 1) and part (P, Q or rest: the transfer
// settings).
#pragma once
#include <string>
#include <vector>

#include "base/files/io.h"

namespace synpo {

struct PairRow {
  std::string env, task;
  bool seen = true;   // no such column: every row counts as seen
  std::string part;   // empty where there is no such column
  uint64_t line = 0;  // of the file that it was read from; 0: none
};

// Throws kData for a missing column, a repeated pair, a seen that is neither 0 nor 1, another part, no row, or more
// than a million rows. Unknown columns are ignored.
std::vector<PairRow> read_pairs(Input& input);
// The part column is written when any row has a part.
void write_pairs(Output& output, const std::vector<PairRow>& rows);

}  // namespace synpo
