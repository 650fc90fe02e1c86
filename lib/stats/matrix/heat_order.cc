#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "stats/matrix/heat_table.h"

namespace synpo {
namespace {

using Names = std::vector<std::string>;
using Line = std::vector<const HeatCell*>;  // the cells of a task, or of an environment, in all panels

// The names of all panels, as they appear first.
Names united(const std::vector<HeatPanel>& panels, Names HeatTable::*names) {
  Names all;
  std::set<std::string> known;
  for (const HeatPanel& panel : panels)
    for (const std::string& name : panel.table.*names)
      if (known.insert(name).second) all.push_back(name);
  return all;
}

// Gives every panel the groups, or parts, of any; `index` is what a cell calls them by.
void unite_groups(std::vector<HeatPanel>& panels, std::vector<HeatGroup> HeatTable::*groups, int HeatCell::*index) {
  const auto new_last = [](const std::string& a, const std::string& b) {
    return std::pair(a == "new", a) < std::pair(b == "new", b);
  };
  std::map<std::string, int, decltype(new_last)> place(new_last);
  for (const HeatPanel& panel : panels)
    for (const HeatGroup& group : panel.table.*groups) place[group.name];
  int next = 0;
  for (auto& [name, at] : place) at = next++;
  for (HeatPanel& panel : panels) {
    std::vector<HeatGroup> all;
    for (const auto& [name, at] : place) all.emplace_back(name);
    for (const HeatGroup& group : panel.table.*groups) all[place[group.name]] = group;
    for (HeatCell& cell : panel.table.cells)
      if (cell.*index >= 0) cell.*index = place[(panel.table.*groups)[cell.*index].name];
    panel.table.*groups = all;
  }
}

std::map<std::string, size_t> places(const Names& names) {
  std::map<std::string, size_t> out;
  for (size_t i = 0; i < names.size(); ++i) out[names[i]] = i;
  return out;
}

// Lays all panels out anew, for these names; what a panel lacks stays empty.
void lay_out_cells(std::vector<HeatPanel>& panels, const Names& tasks, const Names& envs) {
  const auto task_place = places(tasks), env_place = places(envs);
  for (HeatPanel& panel : panels) {
    HeatTable& table = panel.table;
    std::vector<size_t> column;
    for (const std::string& env : table.envs) column.push_back(env_place.at(env));
    std::vector<HeatCell> cells(tasks.size() * envs.size());
    for (size_t task = 0; task < table.tasks.size(); ++task) {
      const size_t row = task_place.at(table.tasks[task]);
      for (size_t env = 0; env < column.size(); ++env) cells[row * envs.size() + column[env]] = table.at(task, env);
    }
    table.cells = std::move(cells);
    table.tasks = tasks;
    table.envs = envs;
  }
}

// In the order of `paper` where all are there; else as they are.
Names as_in_paper(const Names& tasks, const Names& paper) {
  const std::set<std::string> given(tasks.begin(), tasks.end());
  Names sorted;
  for (const std::string& task : paper)
    if (given.contains(task)) sorted.push_back(task);
  return sorted.size() == tasks.size() ? sorted : tasks;
}

Names naturally(Names names) {
  std::stable_sort(names.begin(), names.end(), natural_less);
  return names;
}

double mean_rate(const Line& line) {
  HeatMean mean;
  for (const HeatCell* cell : line) mean.add(*cell);
  return mean.pairs > 0 ? mean.mean() : -1;
}

double distance(const Line& a, const Line& b) {
  double sum = 0;
  int64_t both = 0;
  for (size_t i = 0; i < a.size(); ++i)
    if (a[i]->evaluated() && b[i]->evaluated()) {
      const double difference = a[i]->rate() - b[i]->rate();
      sum += difference * difference;
      ++both;
    }
  return both > 0 ? std::sqrt(sum / double(both)) : 1;
}

Dendrogram cluster(const std::vector<Line>& lines, const std::vector<double>& means) {
  constexpr size_t kMostLeaves = 2000;
  const size_t n = lines.size();
  if (n > kMostLeaves) fail(Exit::kData, n, " names cannot be clustered, at most ", kMostLeaves);
  std::vector<double> distances(n * n);
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < i; ++k) distances[i * n + k] = distances[k * n + i] = distance(lines[i], lines[k]);
  return average_linkage(std::move(distances), means);
}

// Puts names in the order that their success rates give; `tree` is that of a clustering.
void sort_by_success(Names& names, const std::vector<Line>& lines, HeatOrder by, std::optional<Dendrogram>& tree) {
  if (names.size() < 2 || (by != HeatOrder::kMean && by != HeatOrder::kCluster)) return;
  std::vector<double> means;
  std::vector<size_t> order;
  for (const Line& line : lines) {
    order.push_back(means.size());
    means.push_back(mean_rate(line));
  }
  if (by == HeatOrder::kCluster) {
    tree = cluster(lines, means);
    order = tree->order();
  } else {
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return means[a] > means[b]; });
  }
  Names sorted;
  for (const size_t i : order) sorted.push_back(names[i]);
  names = sorted;
}

}  // namespace

HeatOrder find_order(const std::string& name) {
  static const std::map<std::string, HeatOrder> orders = {{"paper", HeatOrder::kPaper},
                                                          {"given", HeatOrder::kGiven},
                                                          {"natural", HeatOrder::kNatural},
                                                          {"mean", HeatOrder::kMean},
                                                          {"cluster", HeatOrder::kCluster}};
  const auto found = orders.find(name);
  if (found == orders.end()) throw std::invalid_argument("expected paper, given, natural, mean or cluster");
  return found->second;
}

HeatFigure arrange(std::vector<HeatPanel> panels, const Names& paper_tasks, HeatOrder task_order, HeatOrder env_order) {
  unite_groups(panels, &HeatTable::groups, &HeatCell::group);
  unite_groups(panels, &HeatTable::parts, &HeatCell::part);
  Names tasks = united(panels, &HeatTable::tasks), envs = united(panels, &HeatTable::envs);
  if (tasks.size() * envs.size() * panels.size() > kMostHeatCells)
    fail(Exit::kData, panels.size(), " panels of ", tasks.size(), " tasks x ", envs.size(),
         " environments: expected at most ", kMostHeatCells, " cells");
  if (task_order != HeatOrder::kGiven)
    tasks = task_order == HeatOrder::kNatural ? naturally(tasks) : as_in_paper(tasks, paper_tasks);
  if (env_order != HeatOrder::kGiven) envs = naturally(envs);
  lay_out_cells(panels, tasks, envs);

  std::vector<Line> task_lines(tasks.size()), env_lines(envs.size());
  for (const HeatPanel& panel : panels)
    for (size_t task = 0; task < tasks.size(); ++task)
      for (size_t env = 0; env < envs.size(); ++env) {
        task_lines[task].push_back(&panel.table.at(task, env));
        env_lines[env].push_back(&panel.table.at(task, env));
      }
  HeatFigure figure;
  sort_by_success(tasks, task_lines, task_order, figure.task_tree);
  sort_by_success(envs, env_lines, env_order, figure.env_tree);
  lay_out_cells(panels, tasks, envs);
  figure.panels = std::move(panels);
  return figure;
}

std::vector<HeatMargin> margins_of(const HeatTable& table) {
  std::vector<HeatMargin> margins;
  const int groups = int(table.groups.size());
  for (int group = -1; group < (groups > 1 ? groups : 0); ++group) {
    HeatMargin margin{
        group < 0 ? (groups > 1 ? "mean all" : "mean") : "mean " + table.groups[group].name, group, {}, {}};
    margin.tasks.resize(table.tasks.size());
    margin.envs.resize(table.envs.size());
    for (size_t task = 0; task < table.tasks.size(); ++task)
      for (size_t env = 0; env < table.envs.size(); ++env) {
        const HeatCell& cell = table.at(task, env);
        if (group >= 0 && cell.group != group) continue;
        margin.tasks[task].add(cell);
        margin.envs[env].add(cell);
      }
    margins.push_back(std::move(margin));
  }
  return margins;
}

}  // namespace synpo
