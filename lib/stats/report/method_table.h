// Methods against subsets of pairs: means and standard deviations over runs, as papers print them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/files/io.h"
#include "format/matrix.h"
#include "stats/bootstrap.h"
#include "stats/interval.h"
#include "stats/matrix/runs.h"
#include "stats/report/text_table.h"

namespace synpo {

struct TableCell {
  int64_t runs = 0, pairs = 0;  // runs that have such pairs; different pairs over all of them
  int64_t episodes = 0;
  MeanSd over_runs;     // of the runs' means over their pairs, every pair alike
  double iqm;           // interquartile mean of all values, one per run and pair
  Interval interval;    // 95 %, for the mean; NaN where the mean has no interval
  bool wilson = false;  // the interval is Wilson's, over episodes alone: the runs tell nothing that would widen it
};

struct TableLine {
  std::string label;  // the method; with world, window and temperature where methods share a name
  std::string world, method;
  int64_t window;
  std::optional<double> temperature;
  std::vector<TableCell> cells;  // a subset each
};

struct MethodTable {
  const MeasureKind* measure;
  std::vector<std::string> subsets;
  std::vector<TableLine> lines;
  std::optional<BootstrapPlan> bootstrap;
  std::string mixed_env;  // an environment that is not the same in all runs; empty where there is none
};

// The interval is Student's over runs: for what other runs would do on these pairs. `bootstrap` asks for the stratified
// bootstrap's in its place. Where the measure is a rate it also holds Wilson's for the mean: for what these runs would
// do in other episodes; of one run, or of runs that are all alike, only that one is known. The order of the rows does
// not count.
MethodTable tabulate(const Matrix& matrix, const std::vector<std::string>& subsets, const MeasureKind& measure,
                     const std::optional<BootstrapPlan>& bootstrap = {});

// `brief` leaves out intervals and interquartile means. What the numbers are stands below, in LaTeX as a comment.
std::string method_table_text(const MethodTable& table, TableFormat format, bool brief);
// A row per method and subset. Rates run from 0 to 1.
void write_method_table(Output& output, const MethodTable& table);

}  // namespace synpo
