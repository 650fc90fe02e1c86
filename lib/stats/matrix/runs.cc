#include "stats/matrix/runs.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

#include "base/error.h"
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

std::vector<Group> gather(const Matrix& matrix) {
  struct Place {
    size_t group, run;
  };
  std::vector<Group> groups;
  std::unordered_map<std::string, size_t> group_at, pair_at;
  std::unordered_map<std::string, Place> run_at;
  for (const MatrixRow& row : matrix.rows) {
    const std::string group_key = row.world + '\t' + std::to_string(row.window) + '\t' + row.method;
    const auto [at_group, fresh_group] = group_at.try_emplace(group_key, groups.size());
    if (fresh_group) groups.push_back({row.world, row.method, row.window, matrix.has_part, {}});
    Group& group = groups[at_group->second];
    const std::string run_name = group_key + '\n' + run_key(row);
    const auto [at_run, fresh_run] = run_at.try_emplace(run_name, Place{at_group->second, group.runs.size()});
    if (fresh_run) group.runs.push_back({row.seed, row.updates, {}});
    Run& run = group.runs[at_run->second.run];
    const auto [at_pair, fresh_pair] =
        pair_at.try_emplace(run_name + '\n' + row.env + '\t' + row.task, run.pairs.size());
    if (fresh_pair) run.pairs.push_back({row.env, row.task, row.seen, row.part, {}});
    run.pairs[at_pair->second].tally.add(row);
  }
  return groups;
}

std::string heading(const std::string& method, const std::string& world, int64_t window, int64_t least_updates,
                    int64_t most_updates, const std::vector<uint64_t>& seeds) {
  std::string text = method.empty() ? "unnamed method" : method;
  if (!world.empty()) text += concat(" on ", world, ", window ", window);
  if (most_updates > 0) {
    text += concat(", ", least_updates);
    if (most_updates > least_updates) text += concat(" to ", most_updates);
    text += " updates";
  }
  text += concat(": ", seeds.size(), seeds.size() == 1 ? " run (seed" : " runs (seeds");
  for (size_t i = 0; i < seeds.size() && i < 20; ++i) text += concat(' ', seeds[i]);
  return text + (seeds.size() > 20 ? " ...)" : ")");
}

std::string heading(const Group& group) {
  int64_t least = group.runs[0].updates, most = least;
  for (const Run& run : group.runs) {
    least = std::min(least, run.updates);
    most = std::max(most, run.updates);
  }
  return heading(group.method, group.world, group.window, least, most, group.seeds());
}

bool is_subset(const std::string& name) {
  return name == "seen" || name == "unseen" || name == "all" || name == "P" || name == "Q" || name == "rest";
}

bool belongs(const PairTally& pair, const std::string& subset) {
  if (subset == "all") return true;
  if (subset == "seen") return pair.seen;
  if (subset == "unseen") return !pair.seen;
  return pair.part == subset;
}

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

const MeasureKind& find_measure(const std::string& name) {
  for (const MeasureKind& kind : measure_kinds())
    if (name == kind.name) return kind;
  throw std::invalid_argument("expected success, reward, length, wrong or timeouts");
}

}  // namespace synpo
