#include "stats/report/compare.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"

namespace synpo {
namespace {

std::string pair_key(const MatrixRow& row) { return row.env + '\t' + row.task; }
std::string start_key(const MatrixRow& row) {
  return concat(row.env, '\t', row.task, '\t', row.eval_seed, '\t', row.first_episode, '\t', row.episodes);
}

// What a side has: pairs, pairs with their seen, and rows by their start states.
struct Side {
  explicit Side(const Matrix& matrix) {
    for (const MatrixRow& row : matrix.rows) {
      pairs.insert(pair_key(row));
      seen.insert(pair_key(row) + (row.seen ? "\t1" : "\t0"));
      starts.insert(start_key(row));
    }
  }
  // Where a row of the other side that cannot be compared with this one is counted; null when it can.
  int64_t Comparison::*lacks(const MatrixRow& row, bool any_start) const {
    if (!pairs.contains(pair_key(row))) return &Comparison::only_one;
    if (!seen.contains(pair_key(row) + (row.seen ? "\t1" : "\t0"))) return &Comparison::other_seen;
    return any_start || starts.contains(start_key(row)) ? nullptr : &Comparison::other_starts;
  }
  std::unordered_set<std::string> pairs, seen, starts;
};

// The rows of each that can be compared with the other's; pairs that lose all of theirs are counted in `result`.
std::pair<Matrix, Matrix> common_rows(const Matrix& a, const Matrix& b, bool any_start, Comparison& result) {
  std::unordered_map<std::string, int64_t Comparison::*> left_out;
  std::unordered_set<std::string> kept;
  const auto choose = [&](const Matrix& matrix, const Side& other) {
    Matrix part;
    part.has_part = matrix.has_part;
    for (const MatrixRow& row : matrix.rows) {
      if (const auto reason = other.lacks(row, any_start)) {
        left_out.try_emplace(pair_key(row), reason);
      } else {
        kept.insert(pair_key(row));
        part.rows.push_back(row);
      }
    }
    return part;
  };
  std::pair<Matrix, Matrix> common{choose(a, Side(b)), choose(b, Side(a))};
  for (const auto& [pair, reason] : left_out)
    if (!kept.contains(pair)) ++(result.*reason);
  return common;
}

Group only_group(const MatrixSource& source) {
  std::vector<Group> groups = gather(source.matrix);
  if (groups.size() > 1)
    fail(Exit::kData, source.name,
         ": rows of several methods, worlds or windows: choose with synpo-matrix filter what is to be compared");
  return std::move(groups[0]);
}

// Seeds must name runs for the runs of both sides to be the same experiment twice.
bool same_seeds(const Group& a, const Group& b) {
  const std::vector<uint64_t> seeds_a = a.seeds(), seeds_b = b.seeds();
  const std::set<uint64_t> set_a(seeds_a.begin(), seeds_a.end()), set_b(seeds_b.begin(), seeds_b.end());
  return set_a == set_b && set_a.size() == seeds_a.size() && set_b.size() == seeds_b.size();
}

// The common pairs, a position each, and what the runs of both sides did on them.
struct Paired {
  std::vector<PairChange> pairs;
  PairValues a, b;
};

SubsetChange change_of(const std::string& name, const Paired& paired, size_t runs_a, size_t runs_b, bool matched,
                       const BootstrapPlan& plan) {
  SubsetChange subset;
  subset.name = name;
  PairValues a, b;
  double sum_a = 0, sum_b = 0;
  const auto mean = [](const std::vector<RunValue>& values) {
    double sum = 0;
    for (const RunValue& value : values) sum += value.value;
    return sum / double(values.size());
  };
  for (size_t p = 0; p < paired.pairs.size(); ++p) {
    const PairChange& pair = paired.pairs[p];
    if (!belongs({pair.env, pair.task, pair.seen, pair.part, {}}, name)) continue;
    a.push_back(paired.a[p]);
    b.push_back(paired.b[p]);
    sum_a += mean(a.back());
    sum_b += mean(b.back());
    ++(pair.change() > 0 ? subset.better : pair.change() < 0 ? subset.worse : subset.alike);
  }
  subset.pairs = int64_t(a.size());
  subset.mean_a = sum_a / double(a.size());
  subset.mean_b = sum_b / double(b.size());
  subset.change = subset.mean_b - subset.mean_a;
  subset.interval = bootstrap_difference(a, runs_a, b, runs_b, matched, plan);
  return subset;
}

}  // namespace

Comparison compare(const MatrixSource& a, const MatrixSource& b, bool any_start, const BootstrapPlan& plan) {
  const Group all_a = only_group(a), all_b = only_group(b);
  if (all_a.world != all_b.world)
    fail(Exit::kData, b.name, ": found world ", quoted(all_b.world), ", expected ", quoted(all_a.world), " as in ",
         a.name);
  Comparison result;
  const auto [part_a, part_b] = common_rows(a.matrix, b.matrix, any_start, result);
  if (part_a.rows.empty() || part_b.rows.empty())
    fail(Exit::kData, a.name, " and ", b.name,
         " have no pair with the same start states (eval_seed, first_episode, episodes) and the same seen",
         any_start ? "" : "; --any-start compares other start states, too");

  const Group group_a = only_group({a.name, part_a}), group_b = only_group({b.name, part_b});
  result.heading_a = heading(group_a);
  result.heading_b = heading(group_b);
  result.runs_a = group_a.runs.size();
  result.runs_b = group_b.runs.size();
  result.matched = same_seeds(group_a, group_b);
  result.lost_runs = int64_t(all_a.runs.size() + all_b.runs.size()) - int64_t(result.runs_a + result.runs_b);
  result.plan = plan;

  // Matched runs get one number: that of the seed's rank.
  const auto numbers = [&](const Group& group) {
    std::vector<uint64_t> sorted = group.seeds();
    std::sort(sorted.begin(), sorted.end());
    std::vector<uint32_t> number;
    for (size_t r = 0; r < group.runs.size(); ++r)
      number.push_back(
          result.matched ? uint32_t(std::lower_bound(sorted.begin(), sorted.end(), group.runs[r].seed) - sorted.begin())
                         : r);
    return number;
  };
  Paired paired;
  std::unordered_map<std::string, size_t> place;
  const auto enter = [&](const Group& group, PairValues& values, int64_t PairChange::*k, int64_t PairChange::*n) {
    const std::vector<uint32_t> number = numbers(group);
    for (size_t r = 0; r < group.runs.size(); ++r) {
      for (const PairTally& pair : group.runs[r].pairs) {
        const auto [at, fresh] = place.try_emplace(concat(pair.name(), '\t', pair.seen), paired.pairs.size());
        if (fresh) paired.pairs.push_back({pair.env, pair.task, pair.seen, pair.part, 0, 0, 0, 0, {}});
        std::string& part = paired.pairs[at->second].part;
        if (part.empty()) part = pair.part;
        if (!pair.part.empty() && pair.part != part)
          fail(Exit::kData, a.name, " and ", b.name, ": pair ", quoted(pair.env), ", ", quoted(pair.task),
               " is in part ", quoted(part), " and in ", quoted(pair.part));
        paired.a.resize(paired.pairs.size());
        paired.b.resize(paired.pairs.size());
        values[at->second].push_back({number[r], double(pair.tally.successes) / double(pair.tally.episodes)});
        paired.pairs[at->second].*k += pair.tally.successes;
        paired.pairs[at->second].*n += pair.tally.episodes;
      }
    }
  };
  enter(group_a, paired.a, &PairChange::k_a, &PairChange::n_a);
  enter(group_b, paired.b, &PairChange::k_b, &PairChange::n_b);
  for (PairChange& pair : paired.pairs) pair.interval = newcombe(pair.k_b, pair.n_b, pair.k_a, pair.n_a);

  for (const char* name : {"seen", "unseen", "all", "P", "Q", "rest"}) {
    const SubsetChange subset = change_of(name, paired, result.runs_a, result.runs_b, result.matched, plan);
    if (subset.pairs > 0) result.subsets.push_back(subset);
  }
  result.pairs = std::move(paired.pairs);
  std::stable_sort(result.pairs.begin(), result.pairs.end(), [](const PairChange& x, const PairChange& y) {
    return std::abs(x.change()) > std::abs(y.change());
  });
  return result;
}

}  // namespace synpo
