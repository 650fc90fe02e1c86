#include "stats/matrix/split.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "base/cli/options.h"
#include "base/error.h"
#include "base/random.h"
#include "base/text.h"

namespace synpo {
namespace {

constexpr int64_t kMaxPairs = 1000000;

struct Cell {
  int env, task;
};

template <class T>
void shuffle(std::vector<T>& items, Random& random) {
  for (size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random.below(uint32_t(i))]);
}

// Draws the cells of a table in layers. A layer has exactly one cell in every line of the longer side and, in every
// line of the shorter one, a fair share of that line's open cells: their number over the number of layers left, rounded
// down or up. So k layers cover every line k times. A bipartite graph can always be cut into such layers (de Werra
// 1971), hence none gets stuck.
class Layers {
 public:
  Layers(int longer, int shorter)
      : longer_(longer), shorter_(shorter), open_(shorter, longer), used_(size_t(longer) * shorter, 0) {}

  // The next layer's cells in random order, as (line of the longer side, line of the shorter side).
  std::vector<std::pair<int, int>> next(Random& random) {
    std::vector<int> lines(longer_), order(shorter_);
    std::iota(lines.begin(), lines.end(), 0);
    shuffle(lines, random);
    choices_.assign(longer_, {});
    for (std::vector<int>& choice : choices_) {
      std::iota(order.begin(), order.end(), 0);
      shuffle(order, random);
      choice = order;
    }
    const int left = shorter_ - drawn_;
    holders_.assign(shorter_, {});
    room_.resize(shorter_);
    int lower = 0;
    for (int s = 0; s < shorter_; ++s) lower += room_[s] = open_[s] / left;
    // The lower shares first: augmenting further never takes a line's load down again.
    std::vector<int> waiting;
    for (int line : lines) {
      visited_.assign(shorter_, false);
      if (lower > 0 && place(line))
        --lower;
      else
        waiting.push_back(line);
    }
    for (int s = 0; s < shorter_; ++s) room_[s] = (open_[s] + left - 1) / left;
    for (int line : waiting) {
      visited_.assign(shorter_, false);
      if (!place(line)) fail(Exit::kInternal, "split: no layer found");
    }

    std::vector<std::pair<int, int>> cells;
    for (int s = 0; s < shorter_; ++s) {
      open_[s] -= int(holders_[s].size());
      for (int line : holders_[s]) {
        used_[size_t(line) * shorter_ + s] = 1;
        cells.emplace_back(line, s);
      }
    }
    ++drawn_;
    std::sort(cells.begin(), cells.end());
    shuffle(cells, random);
    return cells;
  }

  bool used(int line, int s) const { return used_[size_t(line) * shorter_ + s]; }

 private:
  // Finds a place in this layer for `line`, moving others along an augmenting path where needed.
  bool place(int line) {
    for (int s : choices_[line]) {
      if (visited_[s] || used(line, s)) continue;
      visited_[s] = true;
      if (int(holders_[s].size()) < room_[s]) {
        holders_[s].push_back(line);
        return true;
      }
      for (int& holder : holders_[s]) {
        if (!place(holder)) continue;
        holder = line;
        return true;
      }
    }
    return false;
  }

  int longer_, shorter_, drawn_ = 0;
  std::vector<int> open_;  // unused cells of a line of the shorter side
  std::vector<char> used_;
  std::vector<std::vector<int>> choices_, holders_;
  std::vector<int> room_;
  std::vector<bool> visited_;
};

// All cells of a table in the order in which they become seen: `cover` layers, then the others in random order.
std::vector<Cell> seen_order(const std::vector<int>& envs, const std::vector<int>& tasks, int64_t cover,
                             uint64_t seed) {
  std::vector<Cell> order;
  if (envs.empty() || tasks.empty()) return order;
  const bool more_envs = envs.size() >= tasks.size();
  const std::vector<int>&longer = more_envs ? envs : tasks, &shorter = more_envs ? tasks : envs;
  const auto cell = [&](int l, int s) { return more_envs ? Cell{longer[l], shorter[s]} : Cell{shorter[s], longer[l]}; };
  Layers layers(int(longer.size()), int(shorter.size()));
  for (int64_t layer = 0; layer < std::min(cover, int64_t(shorter.size())); ++layer) {
    Random random(seed, Purpose::kSplit, 1, uint64_t(layer));
    for (const auto& [l, s] : layers.next(random)) order.push_back(cell(l, s));
  }
  std::vector<Cell> others;
  for (int l = 0; l < int(longer.size()); ++l)
    for (int s = 0; s < int(shorter.size()); ++s)
      if (!layers.used(l, s)) others.push_back(cell(l, s));
  Random random(seed, Purpose::kSplit, 0);
  shuffle(others, random);
  order.insert(order.end(), others.begin(), others.end());
  return order;
}

int position(const std::vector<std::string>& names, const std::string& name, const std::string& given,
             const char* what) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) fail(Exit::kUsage, kSinglePair, given, ": ", quoted(name), " is no ", what, " of this split");
  return int(it - names.begin());
}

// The environments and tasks that have a seen pair of their own, and the pairs that are known before the draw.
struct Singles {
  std::set<int> envs, tasks;  // all of them
  std::vector<Cell> pairs;
  std::set<int> lone_envs, lone_tasks;  // whose pair is drawn
};

Singles find_singles(const SplitPlan& plan) {
  Singles found;
  for (const auto& [env_name, task_name] : plan.singles) {
    const bool has_env = !env_name.empty(), has_task = !task_name.empty();
    const std::string given = env_name + (has_env && has_task ? "," : "") + task_name;
    const int env = has_env ? position(plan.envs, env_name, given, "environment") : 0,
              task = has_task ? position(plan.tasks, task_name, given, "task") : 0;
    if ((has_env && !found.envs.insert(env).second) || (has_task && !found.tasks.insert(task).second))
      fail(Exit::kUsage, kSinglePair, given, ": its environment or its task has another single pair already");
    if (has_env && has_task)
      found.pairs.push_back({env, task});
    else if (has_env)
      found.lone_envs.insert(env);
    else if (has_task)
      found.lone_tasks.insert(task);
  }
  return found;
}

// Which pairs are seen of a table of `envs` x `tasks` pairs, as [env * tasks + task].
std::vector<char> draw_seen(const SplitPlan& plan, int envs, int tasks, int64_t count) {
  std::vector<char> seen(size_t(envs) * tasks, 0);
  const Singles single = find_singles(plan);
  std::vector<int> free_envs, free_tasks;
  for (int env = 0; env < envs; ++env)
    if (!single.envs.contains(env)) free_envs.push_back(env);
  for (int task = 0; task < tasks; ++task)
    if (!single.tasks.contains(task)) free_tasks.push_back(task);
  if ((!single.lone_envs.empty() && free_tasks.empty()) || (!single.lone_tasks.empty() && free_envs.empty()))
    fail(Exit::kUsage, "no environment or no task is left that a single one could be seen with");

  for (const Cell& cell : single.pairs) seen[size_t(cell.env) * tasks + cell.task] = 1;
  for (int env : single.lone_envs) {
    Random random(plan.seed, Purpose::kSplit, 2, uint64_t(env));
    seen[size_t(env) * tasks + free_tasks[random.below(uint32_t(free_tasks.size()))]] = 1;
  }
  for (int task : single.lone_tasks) {
    Random random(plan.seed, Purpose::kSplit, 3, uint64_t(task));
    seen[size_t(free_envs[random.below(uint32_t(free_envs.size()))]) * tasks + task] = 1;
  }

  const int64_t singles = int64_t(single.pairs.size() + single.lone_envs.size() + single.lone_tasks.size());
  const int64_t longer = int64_t(std::max(free_envs.size(), free_tasks.size()));
  const int64_t shorter = int64_t(std::min(free_envs.size(), free_tasks.size()));
  const int64_t most = singles + longer * shorter;
  if (count < std::max<int64_t>(singles, 1) || count > most)
    fail(Exit::kUsage, "cannot have ", count, " seen pairs: ", envs, " x ", tasks, " pairs",
         singles ? " with these single ones" : "", " allow ", std::max<int64_t>(singles, 1), " to ", most);
  if (plan.cover > shorter)
    fail(Exit::kUsage, "cannot cover every environment and task ", plan.cover, " times: at most ", shorter,
         " times is possible");
  if (plan.cover > 0 && count < singles + plan.cover * longer)
    fail(Exit::kUsage, "cannot cover every environment and task ", plan.cover, " times with ", count,
         " seen pairs: it takes ", singles + plan.cover * longer);

  const std::vector<Cell> order =
      seen_order(free_envs, free_tasks, plan.cover < 0 ? kSplitCover : plan.cover, plan.seed);
  for (int64_t i = 0; i < count - singles; ++i) seen[size_t(order[i].env) * tasks + order[i].task] = 1;
  return seen;
}

void check_names(const std::vector<std::string>& names, const char* what) {
  if (names.empty()) fail(Exit::kUsage, "there is no ", what, " to split");
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (name.empty()) fail(Exit::kUsage, what == std::string("task") ? "a " : "an ", what, " has no name");
    if (const std::string fault = fault_of_name(name); !fault.empty())
      fail(Exit::kUsage, "the ", what, " ", quoted(name), ": ", fault);
    if (!known.insert(name).second) fail(Exit::kUsage, "the ", what, " ", quoted(name), " is named twice");
  }
}

}  // namespace

std::vector<SplitPair> split_pairs(const SplitPlan& plan) {
  check_names(plan.envs, "environment");
  check_names(plan.tasks, "task");
  const int envs = int(plan.envs.size()), tasks = int(plan.tasks.size());
  if (int64_t{envs} * tasks > kMaxPairs)
    fail(Exit::kUsage, "split: ", envs, " x ", tasks, " pairs, at most ", kMaxPairs);
  const bool parts = plan.setting != 1;
  if (parts && !plan.singles.empty()) fail(Exit::kUsage, "single pairs belong to setting 1");
  if (!parts && (plan.p_envs >= 0 || plan.p_tasks >= 0)) fail(Exit::kUsage, "setting 1 has no part P");

  const int64_t p_envs = !parts ? envs : plan.p_envs < 0 ? (envs + 1) / 2 : plan.p_envs;
  const int64_t p_tasks = !parts ? tasks : plan.p_tasks < 0 ? (tasks + 1) / 2 : plan.p_tasks;
  if (parts && (p_envs < 1 || p_envs >= envs || p_tasks < 1 || p_tasks >= tasks))
    fail(Exit::kUsage, "part P of ", p_envs, " environments and ", p_tasks,
         " tasks, expected at least 1 and fewer than the ", envs, " and ", tasks, " there are");
  const double ratio = plan.ratio > 0 ? plan.ratio : parts ? 1 : kSeenRatio;
  const int64_t count =
      plan.seen >= 0 ? plan.seen : std::max<int64_t>(1, std::llround(ratio * double(p_envs * p_tasks)));
  const std::vector<char> seen = draw_seen(plan, int(p_envs), int(p_tasks), count);

  std::vector<SplitPair> pairs;
  for (int env = 0; env < envs; ++env) {
    for (int task = 0; task < tasks; ++task) {
      SplitPair pair{plan.envs[env], plan.tasks[task], false, ""};
      const bool old_env = env < p_envs, old_task = task < p_tasks;
      if (old_env && old_task) {
        pair.seen = seen[size_t(env) * p_tasks + task];
        if (parts) pair.part = "P";
      } else {
        pair.seen = plan.setting == 2 ? old_env != old_task : !old_env && !old_task;
        pair.part = pair.seen ? "Q" : "rest";
      }
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

std::vector<std::string> split_names(const std::string& list) {
  std::vector<std::string> names(1);
  for (char c : list) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c;
  }
  return names;
}

std::pair<std::string, std::string> split_pair_name(const std::string& text) {
  const std::vector<std::string> names = split_names(text);
  if (names.size() != 2) throw std::invalid_argument("expected ENV,TASK");
  return {names[0], names[1]};
}

std::optional<int64_t> count_of_names(const std::string& chosen) {
  const bool digits = chosen.find_first_not_of("0123456789") == std::string::npos;
  try {
    return parse_count(chosen);
  } catch (const std::invalid_argument&) {
    return digits ? std::optional(INT64_MAX) : std::nullopt;
  }
}

std::vector<std::string> choose_names(const std::string& option, const std::string& chosen,
                                      const std::vector<std::string>& names) {
  if (chosen.empty()) return names;
  if (const std::optional<int64_t> count = count_of_names(chosen)) {
    if (*count < 1 || *count > int64_t(names.size()))
      fail(Exit::kUsage, option, " ", chosen, ": expected 1 to ", names.size(), ", or names");
    return {names.begin(), names.begin() + std::ptrdiff_t(*count)};
  }
  std::vector<std::string> list = split_names(chosen);
  for (const std::string& name : list)
    if (std::find(names.begin(), names.end(), name) == names.end())
      fail(Exit::kUsage, option, ": there is no ", quoted(name), ", expected names such as ", names.front(),
           " or a count", did_you_mean(name, names));
  return list;
}

}  // namespace synpo
