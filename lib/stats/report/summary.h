// The summary of a success matrix over its seen and unseen pairs.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files/io.h"
#include "format/matrix.h"
#include "stats/interval.h"

namespace synpo {

// A rate or a mean per episode: over the episodes of all runs together, and the runs' own values compared.
struct Measure {
  double pooled;
  MeanSd over_runs;
};

// NaN stands wherever there is no episode, no second run for an sd, or no number in the matrix (columns missing in one
// made by hand).
struct SubsetSummary {
  std::string name;   // seen, unseen, all; new where there are such pairs; P, Q, rest where the matrix has parts
  int64_t runs = 0;   // that have such pairs
  int64_t pairs = 0;  // different pairs over all runs
  int64_t episodes = 0, successes = 0;
  Interval interval;  // Wilson, 95 %, of successes in episodes
  double pair_mean;   // mean success of a run's pairs, every pair alike; then the mean over runs
  Measure success, reward, length, wrong, timeouts;
};

// The runs of one method in one world with one window, acting at one temperature.
struct GroupSummary {
  std::string heading;
  std::string world, method;
  int64_t window;
  std::optional<double> temperature;
  int64_t runs;
  int64_t least_updates, most_updates;
  std::vector<SubsetSummary> subsets;
  std::vector<std::string> notes;  // what a reader of the numbers should know
};

// Groups in the order of their first row. Rows are taken as they are: merge_matrices first keeps double counting out.
std::vector<GroupSummary> summarise(const Matrix& matrix);

// Aligned text for people, and a table with a row per group and subset. `paint` may put colour on the name of a subset
// as it stands at the beginning of its line.
using PaintName = std::function<std::string(const SubsetSummary& subset, const std::string& name)>;
std::string summary_text(const std::vector<GroupSummary>& groups, const PaintName& paint = nullptr);
void write_summary(Output& output, const std::vector<GroupSummary>& groups);

}  // namespace synpo
