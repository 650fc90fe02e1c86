#include "stats/matrix/runs.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "base/error.h"
#include "base/text.h"
#include "stats/matrix/merge.h"

namespace synpo {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double ratio(double sum, int64_t count) { return count > 0 ? sum / double(count) : kNone; }

double success(const Tally& t) { return ratio(double(t.successes), t.episodes); }
double length(const Tally& t) { return t.unknown_lengths == 0 ? ratio(double(t.length), t.episodes) : kNone; }
double reward(const Tally& t) { return t.unknown_rewards == 0 ? ratio(t.reward, t.episodes) : kNone; }
double wrong(const Tally& t) { return t.unknown_failures == 0 ? ratio(double(t.wrong), t.episodes) : kNone; }
double timeouts(const Tally& t) { return t.unknown_failures == 0 ? ratio(double(t.timeouts), t.episodes) : kNone; }

}  // namespace

void Tally::add(const Tally& other) {
  add_counts(*this, other);
  unknown_failures += other.unknown_failures;
  unknown_lengths += other.unknown_lengths;
  unknown_rewards += other.unknown_rewards;
}
void Tally::add(const MatrixRow& row) {
  add_counts(*this, row);
  if (!row.knows_failures()) unknown_failures += row.episodes;
  if (!row.knows_length()) unknown_lengths += row.episodes;
  if (!row.knows_reward()) unknown_rewards += row.episodes;
}

std::vector<uint64_t> Group::seeds() const {
  std::vector<uint64_t> all;
  for (const Run& run : runs) all.push_back(run.seed);
  return all;
}

std::pair<int64_t, int64_t> Group::updates() const {
  const auto [least, most] =
      std::minmax_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.updates < b.updates; });
  return {least->updates, most->updates};
}

std::vector<Group> group_runs(const Matrix& matrix) {
  struct Place {
    size_t group, run;
  };
  std::vector<Group> groups;
  std::unordered_map<std::string, size_t> group_at, pair_at;
  std::unordered_map<std::string, Place> run_at;
  for (const MatrixRow& row : matrix.rows) {
    const std::string group_key =
        concat(row.world, '\t', row.window, '\t', row.method, '\t', row.temperature ? shortest(*row.temperature) : "");
    const auto [at_group, fresh_group] = group_at.try_emplace(group_key, groups.size());
    if (fresh_group) groups.push_back({row.world, row.method, row.window, row.temperature, false, {}});
    Group& group = groups[at_group->second];
    group.parts |= !row.part.empty();
    const std::string run_name = group_key + '\n' + run_key(row);
    const auto [at_run, fresh_run] = run_at.try_emplace(run_name, Place{at_group->second, group.runs.size()});
    if (fresh_run) group.runs.push_back({row.seed, row.updates, {}});
    Run& run = group.runs[at_run->second.run];
    const auto [at_pair, fresh_pair] =
        pair_at.try_emplace(run_name + '\n' + row.env + '\t' + row.task, run.pairs.size());
    if (fresh_pair) run.pairs.push_back({row.env, row.task, row.standing(), row.part, {}});
    run.pairs[at_pair->second].tally.add(row);
  }
  return groups;
}

std::string heading(const Group& group) {
  const auto [least, most] = group.updates();
  std::string text = group.method.empty() ? "unnamed method" : printable(group.method);
  if (!group.world.empty()) text += concat(" on ", printable(group.world), ", window ", group.window);
  if (most > 0) {
    text += ", " + (most > least ? concat(least, " to ") : "") + counted(int64_t(most), "update");
  }
  if (group.temperature) text += ", temperature " + shortest(*group.temperature);
  const std::vector<uint64_t> seeds = group.seeds();
  text += concat(": ", counted(int64_t(seeds.size()), "run"), seeds.size() == 1 ? " (seed" : " (seeds");
  for (size_t i = 0; i < seeds.size() && i < 20; ++i) text += concat(' ', seeds[i]);
  return text + (seeds.size() > 20 ? " ...)" : ")");
}

std::string mixed_environment(const std::vector<const MatrixRow*>& rows) {
  std::unordered_map<std::string, const std::string*> hash_of;
  for (const MatrixRow* row : rows)
    if (!row->env_hash.empty() && *hash_of.try_emplace(row->env, &row->env_hash).first->second != row->env_hash)
      return row->env;
  return "";
}

std::string mixed_environment(const Matrix& matrix) {
  std::vector<const MatrixRow*> rows;
  for (const MatrixRow& row : matrix.rows) rows.push_back(&row);
  return mixed_environment(rows);
}

const std::vector<std::string>& subset_names() {
  static const std::vector<std::string> names = {"seen", "unseen", "new", "all", "P", "Q", "rest"};
  return names;
}

bool is_subset(const std::string& name) {
  return std::find(subset_names().begin(), subset_names().end(), name) != subset_names().end();
}

bool belongs(Standing standing, const std::string& part, const std::string& subset) {
  return subset == "all" || subset == name_of(standing) || subset == part;
}

bool belongs(const PairTally& pair, const std::string& subset) { return belongs(pair.standing, pair.part, subset); }

const std::vector<MeasureKind>& measure_kinds() {
  static const std::vector<MeasureKind> kinds = {
      {"success", success, true, 1, [](const Tally& t) { return t.successes; }},
      {"reward", reward, false, 2, nullptr},
      {"length", length, false, 1, nullptr},
      {"wrong", wrong, true, 1, [](const Tally& t) { return t.wrong; }},
      {"timeouts", timeouts, true, 1, [](const Tally& t) { return t.timeouts; }},
  };
  return kinds;
}

const MeasureKind& find_measure(std::string_view name) {
  for (const MeasureKind& kind : measure_kinds())
    if (name == kind.name) return kind;
  throw std::invalid_argument("expected success, reward, length, wrong or timeouts");
}

}  // namespace synpo
