// Methods against subsets of pairs: means and standard deviations over runs, as papers print them.
#pragma once
#include <string>
#include <vector>

#include "base/files/io.h"
#include "format/matrix.h"
#include "stats/bootstrap.h"
#include "stats/matrix/runs.h"
#include "stats/report/text_table.h"

namespace synpo {

struct TableCell {
  int64_t runs = 0, pairs = 0;  // runs that have such pairs; different pairs over all of them
  int64_t episodes = 0;
  MeanSd over_runs;     // of the runs' means over their pairs, every pair alike
  double iqm;           // interquartile mean of all values, one per run and pair
  Interval interval;    // 95 %, for the mean; NaN where there is none
  bool wilson = false;  // the interval is Wilson's for all successes in all episodes: the runs could tell nothing
};

struct TableLine {
  std::string label;  // the method; with world and window where methods share a name
  std::string world, method;
  int64_t window;
  std::vector<TableCell> cells;  // a subset each
};

struct MethodTable {
  const MeasureKind* measure;
  std::vector<std::string> subsets;
  std::vector<TableLine> lines;
  BootstrapPlan plan;
};

// The interval is the bootstrap's over runs. With one run, or runs that are all alike, it is Wilson's where the measure
// is a rate.
MethodTable tabulate(const Matrix& matrix, const std::vector<std::string>& subsets, const MeasureKind& measure,
                     const BootstrapPlan& plan);

// `brief` leaves out interquartile means and intervals. What the numbers are stands below, in LaTeX as a comment.
std::string method_table_text(const MethodTable& table, TableFormat format, bool brief);
// A row per method and subset. Rates run from 0 to 1.
void write_method_table(Output& output, const MethodTable& table);

}  // namespace synpo
