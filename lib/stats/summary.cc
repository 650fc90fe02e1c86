#include "stats/summary.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <unordered_map>

#include "base/error.h"
#include "stats/merge.h"

namespace synpo {
namespace {

struct Tally {
  int64_t episodes = 0, successes = 0, wrong = 0, timeouts = 0, length = 0;
  double reward = 0;

  template <class Counts>  // a Tally or a MatrixRow
  void add(const Counts& other) {
    episodes += other.episodes;
    successes += other.successes;
    wrong += other.wrong;
    timeouts += other.timeouts;
    length += other.length;
    reward = add_rewards(reward, other.reward);
  }
};

struct Pair {
  std::string name;
  bool seen;
  std::string part;
  Tally tally;
};

struct Run {
  uint64_t seed;
  int64_t updates;
  std::vector<Pair> pairs;
  std::unordered_map<std::string, size_t> index;
};

struct Group {
  const MatrixRow* first;
  bool parts = false;
  std::vector<Run> runs;
  std::unordered_map<std::string, size_t> index;
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double ratio(double sum, int64_t count) { return count > 0 ? sum / double(count) : kNone; }

double success(const Tally& t) { return ratio(double(t.successes), t.episodes); }
// A matrix made by hand may lack columns, which are 0 then. No episode is without a step, and one that failed ended in some way,
// so zeros that cannot be are numbers that nobody took.
double length(const Tally& t) { return t.length > 0 ? ratio(double(t.length), t.episodes) : kNone; }
double reward(const Tally& t) { return t.length > 0 || t.reward != 0 ? ratio(t.reward, t.episodes) : kNone; }
bool knows_failures(const Tally& t) { return t.wrong > 0 || t.timeouts > 0 || t.successes == t.episodes; }
double wrong(const Tally& t) { return knows_failures(t) ? ratio(double(t.wrong), t.episodes) : kNone; }
double timeouts(const Tally& t) { return knows_failures(t) ? ratio(double(t.timeouts), t.episodes) : kNone; }

std::vector<Group> gather(const Matrix& matrix) {
  std::vector<Group> groups;
  std::unordered_map<std::string, size_t> index;
  for (const MatrixRow& row : matrix.rows) {
    const auto [at_group, fresh_group] = index.try_emplace(concat(row.world, '\t', row.window, '\t', row.method), groups.size());
    if (fresh_group) groups.push_back({&row, matrix.has_part, {}, {}});
    Group& group = groups[at_group->second];
    const auto [at_run, fresh_run] = group.index.try_emplace(run_key(row), group.runs.size());
    if (fresh_run) group.runs.push_back({row.seed, row.updates, {}, {}});
    Run& run = group.runs[at_run->second];
    const auto [at_pair, fresh_pair] = run.index.try_emplace(row.env + '\t' + row.task, run.pairs.size());
    if (fresh_pair) run.pairs.push_back({at_pair->first, row.seen, row.part, {}});
    run.pairs[at_pair->second].tally.add(row);
  }
  return groups;
}

SubsetSummary summarise_subset(const std::string& name, const Group& group, const std::function<bool(const Pair&)>& belongs) {
  SubsetSummary subset;
  subset.name = name;
  Tally total;
  std::set<std::string> names;
  std::vector<double> pair_means;
  std::vector<Tally> run_tallies;
  for (const Run& run : group.runs) {
    Tally tally;
    std::vector<double> rates;
    for (const Pair& pair : run.pairs) {
      if (!belongs(pair)) continue;
      tally.add(pair.tally);
      rates.push_back(success(pair.tally));
      names.insert(pair.name);
    }
    if (rates.empty()) continue;
    total.add(tally);
    run_tallies.push_back(tally);
    pair_means.push_back(mean_sd(rates).mean);
  }
  const auto measure = [&](double (*value)(const Tally&)) {
    std::vector<double> values;
    for (const Tally& tally : run_tallies) values.push_back(value(tally));
    return Measure{value(total), mean_sd(values)};
  };
  subset.runs = int64_t(run_tallies.size());
  subset.pairs = int64_t(names.size());
  subset.episodes = total.episodes;
  subset.successes = total.successes;
  subset.interval = wilson(total.successes, total.episodes);
  subset.pair_mean = mean_sd(pair_means).mean;
  subset.success = measure(success);
  subset.reward = measure(reward);
  subset.length = measure(length);
  subset.wrong = measure(wrong);
  subset.timeouts = measure(timeouts);
  return subset;
}

std::vector<std::string> notes_on(const Group& group) {
  std::vector<std::string> notes;
  std::set<uint64_t> seeds;
  const auto pairs_of = [](const Run& run) {
    std::set<std::pair<std::string, bool>> pairs;
    for (const Pair& pair : run.pairs) pairs.emplace(pair.name, pair.seen);
    return pairs;
  };
  bool repeated = false, different = false;
  for (const Run& run : group.runs) {
    repeated |= !seeds.insert(run.seed).second;
    different |= &run != &group.runs[0] && pairs_of(run) != pairs_of(group.runs[0]);
  }
  const std::string name = group.first->method.empty() ? "" : quoted(group.first->method) + ": ";
  if (repeated) notes.push_back(name + "several runs name the same seed, so their sd is not one over seeds");
  if (different) notes.push_back(name + "the runs differ in their pairs, or in which of them are seen");
  return notes;
}

}  // namespace

std::vector<GroupSummary> summarise(const Matrix& matrix) {
  std::vector<GroupSummary> summaries;
  for (const Group& group : gather(matrix)) {
    GroupSummary summary{group.first->world, group.first->method, group.first->window, {}, group.runs[0].updates,
                         group.runs[0].updates, {}, notes_on(group)};
    for (const Run& run : group.runs) {
      summary.seeds.push_back(run.seed);
      summary.least_updates = std::min(summary.least_updates, run.updates);
      summary.most_updates = std::max(summary.most_updates, run.updates);
    }
    summary.subsets.push_back(summarise_subset("seen", group, [](const Pair& pair) { return pair.seen; }));
    summary.subsets.push_back(summarise_subset("unseen", group, [](const Pair& pair) { return !pair.seen; }));
    summary.subsets.push_back(summarise_subset("all", group, [](const Pair&) { return true; }));
    if (group.parts)
      for (const char* part : {"P", "Q", "rest"})
        summary.subsets.push_back(summarise_subset(part, group, [&](const Pair& pair) { return pair.part == part; }));
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace synpo
