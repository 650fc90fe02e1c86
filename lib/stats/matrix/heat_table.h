// Success matrices made ready to be shown: counts pooled for each pair, names in order, several matrices side by side.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "format/matrix.h"
#include "stats/cluster.h"

namespace synpo {

constexpr size_t kMostHeatNames = 100'000, kMostHeatCells = 4'000'000;  // tasks or environments; cells of all panels

struct HeatCell {
  int64_t episodes = 0, successes = 0;  // summed over the runs; no episodes: drawn as empty
  int group = -1;                       // index into HeatTable::groups; -1 where the matrix has no such pair
  int part = -1;                        // index into HeatTable::parts
  bool evaluated() const { return episodes > 0; }
  double rate() const { return double(successes) / double(episodes); }
};

// A mean of pairs' rates, every pair alike.
struct HeatMean {
  int64_t pairs = 0, episodes = 0, successes = 0;  // of the pairs evaluated
  double rates = 0;                                // their sum
  int64_t each = 0;                                // episodes of every pair; -1 where they differ
  void add(const HeatCell& cell);                  // nothing where the cell was not evaluated
  bool evaluated() const { return pairs > 0; }
  // Of counts where they give it, so that lines of equal counts are equal.
  double mean() const { return each >= 0 ? rate() : rates / double(pairs); }
  double rate() const { return double(successes) / double(episodes); }  // over all episodes together
};

// A kind of pairs with a mean of its own: seen, unseen and new, or a part.
struct HeatGroup : HeatMean {
  std::string name;
  int64_t members = 0;  // pairs, evaluated or not
  HeatGroup(std::string its_name) : name(std::move(its_name)) {}
};

struct HeatTable {
  std::vector<std::string> envs, tasks;
  std::vector<HeatCell> cells;    // [tasks, envs]
  std::vector<HeatGroup> groups;  // what the colours tell apart, only what occurs
  std::vector<HeatGroup> parts;   // empty where the matrix has none
  bool by_part = false;           // groups are the parts
  bool split = false;             // of pairs that nobody evaluated: the group is all that a cell has
  std::string caption;            // method, runs and episodes, in words
  const HeatCell& at(size_t task, size_t env) const { return cells[task * envs.size() + env]; }
};

// Sums the rows of each pair over runs and shards. Names come as they appear first. `method` empty: all rows. Throws
// kData when the rows left are of several methods (kSeveralMethods), worlds or temperatures, when other environments go
// by one name, when a pair is seen in one row and unseen or new in another (or in two parts), when no row is left, for
// `by_part` without parts, and for more names or cells than the above.
constexpr Cause kSeveralMethods{"several methods"};
HeatTable pool_matrix(const Matrix& matrix, const std::string& method = "", bool by_part = false);

// How tasks or environments are ordered.
enum class HeatOrder {
  kPaper,    // tasks in the order of a paper where it has them all, else as they appear first; environments naturally
  kGiven,    // as they appear first
  kNatural,  // map2 before map10
  kMean,     // highest success first
  kCluster,  // by average linkage of their success rates
};
// Throws std::invalid_argument for a name that is not one of paper, given, natural, mean, cluster.
HeatOrder find_order(const std::string& name);

struct HeatPanel {
  std::string title;
  HeatTable table;
};

struct HeatFigure {
  std::vector<HeatPanel> panels;  // of the same tasks, environments, groups and parts, in the same order
  std::optional<Dendrogram> task_tree, env_tree;  // of kCluster, over two names or more; row i is leaf order()[i]
};

// `paper_tasks`: those of GridWorld in the order of Figure 6, for HeatOrder::kPaper.
// Gives all panels the tasks and environments of any; pairs that a panel lacks are empty in it. Means and distances are
// over all panels, of seen and unseen pairs alike. The distance of two tasks is the root of the mean squared difference
// of their success rates where both were evaluated, 1 where none is; so with environments. What is equal keeps the
// order of kPaper. Throws kData for kCluster of more than 2000 names, and for more than kMostHeatCells.
HeatFigure arrange(std::vector<HeatPanel> panels, const std::vector<std::string>& paper_tasks,
                   HeatOrder tasks = HeatOrder::kPaper, HeatOrder envs = HeatOrder::kPaper);

// The mean of each task and each environment: over all its pairs, then over those of each group where there are
// several.
struct HeatMargin {
  std::string name;
  int group;  // -1: all pairs
  std::vector<HeatMean> tasks, envs;
};
std::vector<HeatMargin> margins_of(const HeatTable& table);

// In per cent, as in the hundredths of rate_text(): 83, and 100 and 0 only where all or none succeeded.
int64_t whole_percent(int64_t successes, int64_t episodes);
// "0.83"; 1.00 and 0.00 only where all or none succeeded.
std::string rate_text(int64_t successes, int64_t episodes);
std::string rate_text(const HeatMean& mean);

}  // namespace synpo
