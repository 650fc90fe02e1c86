#include "stats/report/summary.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "stats/matrix/runs.h"

namespace synpo {
namespace {

SubsetSummary summarise_subset(const std::string& name, const Group& group) {
  SubsetSummary subset;
  subset.name = name;
  Tally total;
  std::set<std::string> names;
  std::vector<double> pair_means;
  std::vector<Tally> run_tallies;
  for (const Run& run : group.runs) {
    Tally tally;
    std::vector<double> rates;
    for (const PairTally& pair : run.pairs) {
      if (!belongs(pair, name)) continue;
      tally.add(pair.tally);
      rates.push_back(find_measure("success").value(pair.tally));
      names.insert(pair.name());
    }
    if (rates.empty()) continue;
    total.add(tally);
    run_tallies.push_back(tally);
    pair_means.push_back(mean_sd(rates).mean);
  }
  const auto measure = [&](const char* kind) {
    const auto value = find_measure(kind).value;
    std::vector<double> values;
    for (const Tally& tally : run_tallies) values.push_back(value(tally));
    return Measure{value(total), mean_sd(values)};
  };
  subset.runs = int64_t(run_tallies.size());
  subset.pairs = int64_t(names.size());
  subset.episodes = total.episodes;
  subset.successes = total.successes;
  subset.interval = total.episodes > 0 ? wilson(total.successes, total.episodes) : Interval{NAN, NAN};
  subset.pair_mean = mean_sd(pair_means).mean;
  subset.success = measure("success");
  subset.reward = measure("reward");
  subset.length = measure("length");
  subset.wrong = measure("wrong");
  subset.timeouts = measure("timeouts");
  return subset;
}

std::vector<std::string> notes_on(const Group& group) {
  std::vector<std::string> notes;
  std::set<uint64_t> seeds;
  const auto pairs_of = [](const Run& run) {
    std::set<std::pair<std::string, Standing>> pairs;
    for (const PairTally& pair : run.pairs) pairs.emplace(pair.name(), pair.standing);
    return pairs;
  };
  bool repeated = false, different = false;
  for (const Run& run : group.runs) {
    repeated |= !seeds.insert(run.seed).second;
    different |= &run != &group.runs[0] && pairs_of(run) != pairs_of(group.runs[0]);
  }
  const std::string name = group.method.empty() ? "" : quoted(group.method) + ": ";
  if (repeated) notes.push_back(name + "several runs name the same seed, so their sd is not one over seeds");
  if (different) notes.push_back(name + "the runs differ in their pairs, or in which of them are seen");
  return notes;
}

}  // namespace

std::vector<GroupSummary> summarise(const Matrix& matrix) {
  std::vector<GroupSummary> summaries;
  for (const Group& group : group_runs(matrix)) {
    const auto [least, most] = group.updates();
    GroupSummary summary{
        heading(group), group.world, group.method, group.window,   group.temperature, int64_t(group.runs.size()),
        least,          most,        {},           notes_on(group)};
    for (const std::string& name : subset_names()) {
      SubsetSummary subset = summarise_subset(name, group);
      const bool part = name == "P" || name == "Q" || name == "rest";
      if (part ? group.parts : name != "new" || subset.pairs > 0) summary.subsets.push_back(std::move(subset));
    }
    summaries.push_back(std::move(summary));
  }
  if (const std::string env = mixed_environment(matrix); !env.empty())
    summaries.front().notes.push_back(
        concat("the environment ", quoted(env), " is not the same in all runs (env_hash): other ones go by its name"));
  return summaries;
}

}  // namespace synpo
