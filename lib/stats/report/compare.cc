#include "stats/report/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "stats/matrix/runs.h"

namespace synpo {
namespace {

std::string pair_key(const MatrixRow& row) { return row.env + '\t' + row.task; }
std::string standing_key(const MatrixRow& row) { return concat(pair_key(row), '\t', name_of(row.standing())); }
std::string start_key(const MatrixRow& row) {
  return concat(standing_key(row), '\t', row.eval_seed, '\t', row.first_episode, '\t', row.episodes);
}

// One side of a comparison: its pairs, pairs with their standing, rows by their start states, and environments by their
// hash.
struct Side {
  explicit Side(const Matrix& matrix) {
    for (const MatrixRow& row : matrix.rows) {
      pairs.insert(pair_key(row));
      standings.insert(standing_key(row));
      starts.insert(start_key(row));
      if (!row.env_hash.empty()) hashes.emplace(row.env, row.env_hash);
    }
  }
  // Where a row of the side `from` that cannot be compared with this one is counted; null when it can.
  LeftOut Comparison::*lacks(const Side& from, const MatrixRow& row, bool any_start) const {
    if (!pairs.contains(pair_key(row))) return &Comparison::only_one;
    // Rows that do not say their environment's hash are of that which others of their side say.
    const auto hash = hashes.find(row.env), own = from.hashes.find(row.env);
    if (hash != hashes.end() && own != from.hashes.end() && hash->second != own->second) return &Comparison::other_env;
    if (!standings.contains(standing_key(row)))
      return row.is_new || standings.contains(concat(pair_key(row), '\t', name_of(Standing::kNew)))
                 ? &Comparison::new_to_one
                 : &Comparison::other_seen;
    return any_start || starts.contains(start_key(row)) ? nullptr : &Comparison::other_starts;
  }
  std::unordered_set<std::string> pairs, standings, starts;
  std::unordered_map<std::string, std::string> hashes;
};

// The rows of each that can be compared with the other's; what is left out is counted in `result`.
std::pair<Matrix, Matrix> common_rows(const Matrix& a, const Matrix& b, bool any_start, Comparison& result) {
  std::unordered_map<std::string, LeftOut Comparison::*> lost;
  std::vector<std::pair<std::string, LeftOut Comparison::*>> lost_rows;
  std::unordered_set<std::string> kept;
  const auto choose = [&](const Matrix& matrix, const Side& own, const Side& other) {
    Matrix part;
    for (const MatrixRow& row : matrix.rows) {
      if (const auto reason = other.lacks(own, row, any_start)) {
        lost.try_emplace(pair_key(row), reason);
        lost_rows.emplace_back(pair_key(row), reason);
      } else {
        kept.insert(pair_key(row));
        part.rows.push_back(row);
      }
    }
    return part;
  };
  const Side of_a(a), of_b(b);
  std::pair<Matrix, Matrix> common{choose(a, of_a, of_b), choose(b, of_b, of_a)};
  for (const auto& [pair, reason] : lost)
    if (!kept.contains(pair)) ++(result.*reason).pairs;
  for (const auto& [pair, reason] : lost_rows)
    if (kept.contains(pair)) ++(result.*reason).rows;
  return common;
}

Group only_group(const MatrixSource& source) {
  std::vector<Group> groups = group_runs(source.matrix);
  if (groups.size() > 1) {
    const bool temperatures = std::all_of(groups.begin(), groups.end(), [&](const Group& group) {
      return group.world == groups[0].world && group.window == groups[0].window && group.method == groups[0].method;
    });
    fail(Exit::kData, source.name, ": rows of several ", temperatures ? "temperatures" : "methods, worlds or windows",
         ": choose with synpo-matrix filter what is to be compared");
  }
  if (const std::string env = mixed_environment(source.matrix); !env.empty())
    fail(Exit::kData, source.name, ": the environment ", quoted(env),
         " is not the same in all rows (env_hash): other ones go by its name");
  return std::move(groups[0]);
}

// Seeds must name runs for the runs of both sides to be the same experiment twice.
bool same_seeds(const Group& a, const Group& b) {
  const std::vector<uint64_t> seeds_a = a.seeds(), seeds_b = b.seeds();
  const std::set<uint64_t> set_a(seeds_a.begin(), seeds_a.end()), set_b(seeds_b.begin(), seeds_b.end());
  return set_a == set_b && set_a.size() == seeds_a.size() && set_b.size() == seeds_b.size();
}

// The outcome of a run on a pair.
struct RunCounts {
  size_t run;
  Standing standing;
  int64_t successes, episodes;
  double rate() const { return double(successes) / double(episodes); }
};

// A pair that both sides have.
struct Paired {
  size_t place;  // in the order of the matrices
  std::string part;
  std::vector<RunCounts> a, b;
};
using PairName = std::pair<std::string, std::string>;  // environment, task
using PairedPairs = std::map<PairName, Paired>;

// Mean and sd of the values in rising order, so that the order in which they came does not count.
MeanSd mean_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return mean_sd(values);
}

// The part of a squared half width that one source of chance makes: t^2 times its variance.
double squared_half(double variance, double df) { return variance > 0 ? std::pow(student95(df), 2) * variance : 0; }

// Of one side in a subset of pairs.
class SideSum {
 public:
  // Adds what the runs did on one of the pairs; returns its mean over them.
  double add(const std::vector<RunCounts>& runs) {
    std::vector<double> rates;
    double lengths = 0;
    for (const RunCounts& run : runs) {
      rates.push_back(run.rate());
      by_run_[run.run].push_back(run.rate());
      lengths += 1 / double(run.episodes);
      successes += run.successes;
      episodes += run.episodes;
    }
    variances_ += lengths / double(runs.size()) / double(runs.size());
    rates_.push_back(mean_of(std::move(rates)).mean);
    return rates_.back();
  }
  double mean() const { return std::clamp(mean_of(rates_).mean, 0.0, 1.0); }
  // Of as many episodes a single rate would be as sure as the mean is.
  double trials() const { return double(rates_.size()) * double(rates_.size()) / variances_; }
  // Mean and sd of the runs' own means.
  MeanSd over_runs() const {
    std::vector<double> means;
    for (const auto& [run, rates] : by_run_) means.push_back(mean_of(rates).mean);
    return mean_of(std::move(means));
  }

  int64_t successes = 0, episodes = 0;

 private:
  std::map<size_t, std::vector<double>> by_run_;
  std::vector<double> rates_;
  double variances_ = 0;  // of the mean, in units of that of a single episode
};

// The runs' share of the squared half width; `differences` are those of matched runs, empty where there are none.
double runs_share(const MeanSd& a, const MeanSd& b, const std::vector<double>& differences) {
  if (differences.size() > 1) {
    const MeanSd d = mean_of(differences);
    return squared_half(d.sd * d.sd / double(d.count), double(d.count - 1));
  }
  const double in_a = a.sd * a.sd / double(a.count), in_b = b.sd * b.sd / double(b.count);
  if (a.count > 1 && b.count > 1) {
    const double both = in_a + in_b;
    return squared_half(both, both * both / (in_a * in_a / double(a.count - 1) + in_b * in_b / double(b.count - 1)));
  }
  if (a.count == 1 && b.count == 1) return 0;
  const MeanSd& many = a.count > 1 ? a : b;
  return squared_half(many.sd * many.sd * (1 + 1 / double(many.count)), double(many.count - 1));
}

// The pairs' share: `changes` by environment and task.
double pairs_share(const std::map<PairName, double>& changes) {
  std::vector<double> values;
  for (const auto& [pair, change] : changes) values.push_back(change);
  const double mean = mean_of(values).mean, n = double(values.size());
  std::map<std::string, double> envs, tasks;
  double squares = 0;
  for (const auto& [pair, change] : changes) {
    envs[pair.first] += (change - mean) / n;
    tasks[pair.second] += (change - mean) / n;
    squares += std::pow((change - mean) / n, 2);
  }
  const auto variance = [](const std::map<std::string, double>& clusters) {
    const double count = double(clusters.size());
    double sum = 0;
    for (const auto& [name, deviation] : clusters) sum += deviation * deviation;
    return count > 1 ? sum * count / (count - 1) : 0;
  };
  const double by_env = variance(envs), by_task = variance(tasks);
  if (by_env == 0 && by_task == 0) return 0;
  const double one_by_one = squares * n / (n - 1);
  const double both = std::max({by_env + by_task - one_by_one, by_env, by_task});
  // Satterthwaite's degrees of freedom (1946), and no fewer than the smaller side has by itself.
  const auto share = [](double part, double df) { return part > 0 ? part * part / df : 0; };
  const double in_envs = double(envs.size()) - 1, in_tasks = double(tasks.size()) - 1;
  const double df = both * both / (share(by_env, in_envs) + share(by_task, in_tasks));
  return squared_half(both, std::max(df, std::min(in_envs, in_tasks)));
}

double pooled(const std::vector<RunCounts>& runs) {
  int64_t successes = 0, episodes = 0;
  for (const RunCounts& run : runs) {
    successes += run.successes;
    episodes += run.episodes;
  }
  return double(successes) / double(episodes);
}

SubsetChange change_of(const std::string& name, const PairedPairs& pairs, bool matched) {
  SubsetChange subset;
  subset.name = name;
  SideSum a, b;
  std::map<PairName, double> changes;
  std::map<size_t, std::vector<double>> of_runs;  // differences on the pairs that matched runs have both
  for (const auto& [pair, paired] : pairs) {
    std::vector<RunCounts> in_a, in_b;
    for (const RunCounts& run : paired.a)
      if (belongs(run.standing, paired.part, name)) in_a.push_back(run);
    for (const RunCounts& run : paired.b)
      if (belongs(run.standing, paired.part, name)) in_b.push_back(run);
    if (in_a.empty() || in_b.empty()) continue;
    changes[pair] = b.add(in_b) - a.add(in_a);
    // Equal counts are alike, whatever rounding makes of their means.
    const double change = pooled(in_b) - pooled(in_a);
    ++(change > 0 ? subset.better : change < 0 ? subset.worse : subset.alike);
    if (!matched) continue;
    for (const RunCounts& one : in_a)
      for (const RunCounts& other : in_b)
        if (one.run == other.run) of_runs[one.run].push_back(other.rate() - one.rate());
  }
  subset.pairs = int64_t(changes.size());
  if (changes.empty()) return subset;
  subset.k_a = a.successes;
  subset.n_a = a.episodes;
  subset.k_b = b.successes;
  subset.n_b = b.episodes;
  subset.mean_a = a.mean();
  subset.mean_b = b.mean();
  subset.change = subset.mean_b - subset.mean_a;
  std::vector<double> differences;
  for (const auto& [run, values] : of_runs) differences.push_back(mean_of(values).mean);
  const double half = std::sqrt(runs_share(a.over_runs(), b.over_runs(), differences) + pairs_share(changes));
  subset.interval = hull({subset.change - half, subset.change + half},
                         newcombe_of_rates(subset.mean_b, b.trials(), subset.mean_a, a.trials()));
  subset.interval = {std::max(-1.0, subset.interval.low), std::min(1.0, subset.interval.high)};
  return subset;
}

PairChange pair_change(const PairName& name, const Paired& paired) {
  PairChange pair{name.first, name.second, paired.a.front().standing, 0, 0, 0, 0, {}};
  for (const auto* side : {&paired.a, &paired.b})
    for (const RunCounts& run : *side) {
      if (run.standing != pair.standing) pair.standing.reset();
      (side == &paired.a ? pair.k_a : pair.k_b) += run.successes;
      (side == &paired.a ? pair.n_a : pair.n_b) += run.episodes;
    }
  pair.interval = newcombe(pair.k_b, pair.n_b, pair.k_a, pair.n_a);
  return pair;
}

}  // namespace

Comparison compare(const MatrixSource& a, const MatrixSource& b, bool any_start) {
  const Group all_a = only_group(a), all_b = only_group(b);
  if (all_a.world != all_b.world)
    fail(Exit::kData, b.name, ": found world ", quoted(all_b.world), ", expected ", quoted(all_a.world), " as in ",
         a.name);
  Comparison result;
  const auto [part_a, part_b] = common_rows(a.matrix, b.matrix, any_start, result);
  if (part_a.rows.empty() || part_b.rows.empty()) {
    if (result.other_env.pairs > 0)
      fail(Exit::kData, a.name, " and ", b.name, ": other environments go by the same names (env_hash), and ",
           "no pair is left");
    fail(Exit::kData, any_start ? Cause{} : kOtherStarts, a.name, " and ", b.name,
         " have no pair with the same start states (eval_seed, first_episode, episodes) and the same seen");
  }

  const Group group_a = only_group({a.name, part_a}), group_b = only_group({b.name, part_b});
  result.heading_a = heading(group_a);
  result.heading_b = heading(group_b);
  result.temperature_a = group_a.temperature;
  result.temperature_b = group_b.temperature;
  result.runs_a = group_a.runs.size();
  result.runs_b = group_b.runs.size();
  result.matched = same_seeds(group_a, group_b);
  result.lost_runs = int64_t(all_a.runs.size() + all_b.runs.size()) - int64_t(result.runs_a + result.runs_b);

  PairedPairs pairs;
  const auto enter = [&](const Group& group, std::vector<RunCounts> Paired::*side) {
    // Matched runs get one number: that of the seed's rank.
    std::vector<uint64_t> seeds = group.seeds();
    std::sort(seeds.begin(), seeds.end());
    for (size_t r = 0; r < group.runs.size(); ++r) {
      const size_t rank = size_t(std::lower_bound(seeds.begin(), seeds.end(), group.runs[r].seed) - seeds.begin());
      for (const PairTally& pair : group.runs[r].pairs) {
        const auto place = pairs.size();
        Paired& paired = pairs.try_emplace({pair.env, pair.task}, Paired{place, "", {}, {}}).first->second;
        if (paired.part.empty()) paired.part = pair.part;
        if (!pair.part.empty() && pair.part != paired.part)
          fail(Exit::kData, a.name, " and ", b.name, ": pair ", quoted(pair.env), ", ", quoted(pair.task),
               " is in part ", quoted(paired.part), " and in ", quoted(pair.part));
        (paired.*side).push_back({result.matched ? rank : r, pair.standing, pair.tally.successes, pair.tally.episodes});
      }
    }
  };
  enter(group_a, &Paired::a);
  enter(group_b, &Paired::b);

  std::set<std::string> envs, tasks;
  std::vector<const PairedPairs::value_type*> in_order;
  for (const auto& pair : pairs) {
    envs.insert(pair.first.first);
    tasks.insert(pair.first.second);
    in_order.push_back(&pair);
  }
  result.many_envs = envs.size() > 1;
  result.many_tasks = tasks.size() > 1;
  std::sort(in_order.begin(), in_order.end(),
            [](const auto* x, const auto* y) { return x->second.place < y->second.place; });
  for (const auto* pair : in_order) result.pairs.push_back(pair_change(pair->first, pair->second));
  for (const std::string& name : subset_names()) {
    const SubsetChange subset = change_of(name, pairs, result.matched);
    if (subset.pairs > 0) result.subsets.push_back(subset);
  }
  std::stable_sort(result.pairs.begin(), result.pairs.end(), [](const PairChange& x, const PairChange& y) {
    return std::abs(x.change()) > std::abs(y.change());
  });
  return result;
}

}  // namespace synpo
