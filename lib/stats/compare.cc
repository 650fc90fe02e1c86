#include "stats/compare.h"

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

using Keys = std::unordered_set<std::string>;
template <class Key>
Keys keys_of(const Matrix& matrix, Key key) {
  Keys keys;
  for (const MatrixRow& row : matrix.rows) keys.insert(key(row));
  return keys;
}
std::string seen_key(const MatrixRow& row) { return concat(row.env, '\t', row.task, '\t', row.seen); }

Group only_group(const MatrixSource& source) {
  std::vector<Group> groups = gather(source.matrix);
  if (groups.size() > 1)
    fail(Exit::kData, source.name, ": rows of several methods, worlds or windows: choose with synpo-matrix filter what is to be compared");
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
  double sum_a = 0;
  for (size_t p = 0; p < paired.pairs.size(); ++p) {
    const PairChange& pair = paired.pairs[p];
    if (!belongs({pair.env, pair.task, pair.seen, pair.part, {}}, name)) continue;
    a.push_back(paired.a[p]);
    b.push_back(paired.b[p]);
    double sum = 0;
    for (const RunValue& value : a.back()) sum += value.value;
    sum_a += sum / double(a.back().size());
    ++(pair.change() > 0 ? subset.better : pair.change() < 0 ? subset.worse : subset.alike);
  }
  subset.pairs = int64_t(a.size());
  subset.change = mean_difference(a, b);
  subset.mean_a = sum_a / double(a.size());
  subset.mean_b = subset.mean_a + subset.change;
  subset.interval = bootstrap_difference(a, runs_a, b, runs_b, matched, plan);
  return subset;
}

}  // namespace

Comparison compare(const MatrixSource& a, const MatrixSource& b, bool any_start, const BootstrapPlan& plan) {
  const Group all_a = only_group(a), all_b = only_group(b);
  if (all_a.world != all_b.world)
    fail(Exit::kData, b.name, ": found world ", quoted(all_b.world), ", expected ", quoted(all_a.world), " as in ", a.name);
  const Keys pairs_a = keys_of(a.matrix, pair_key), pairs_b = keys_of(b.matrix, pair_key);
  const Keys seen_a = keys_of(a.matrix, seen_key), seen_b = keys_of(b.matrix, seen_key);
  const Keys starts_a = keys_of(a.matrix, start_key), starts_b = keys_of(b.matrix, start_key);

  Comparison result;
  std::unordered_map<std::string, const char*> left_out;  // a pair, and why
  std::unordered_set<std::string> kept;
  const auto common = [&](const Matrix& matrix, const Keys& other_pairs, const Keys& other_seen, const Keys& other_starts) {
    Matrix part;
    part.has_part = matrix.has_part;
    for (const MatrixRow& row : matrix.rows) {
      const char* why = !other_pairs.contains(pair_key(row))                  ? "one"
                        : !other_seen.contains(seen_key(row))                 ? "seen"
                        : any_start || other_starts.contains(start_key(row)) ? nullptr
                                                                              : "starts";
      if (why) {
        left_out.try_emplace(pair_key(row), why);
      } else {
        kept.insert(pair_key(row));
        part.rows.push_back(row);
      }
    }
    return part;
  };
  const Matrix part_a = common(a.matrix, pairs_b, seen_b, starts_b), part_b = common(b.matrix, pairs_a, seen_a, starts_a);
  for (const auto& [pair, why] : left_out) {
    if (kept.contains(pair)) continue;
    ++(*why == 'o' ? result.only_one : why[1] == 'e' ? result.other_seen : result.other_starts);
  }
  if (part_a.rows.empty() || part_b.rows.empty())
    fail(Exit::kData, a.name, " and ", b.name, " have no pair with the same start states (eval_seed, first_episode, episodes) and the same seen",
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
      number.push_back(result.matched ? uint32_t(std::lower_bound(sorted.begin(), sorted.end(), group.runs[r].seed) - sorted.begin()) : r);
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
  std::stable_sort(result.pairs.begin(), result.pairs.end(),
                   [](const PairChange& x, const PairChange& y) { return std::abs(x.change()) > std::abs(y.change()); });
  return result;
}

}  // namespace synpo
