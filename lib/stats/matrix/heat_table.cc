#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "stats/matrix/heat_table.h"
#include "stats/matrix/runs.h"

namespace synpo {
namespace {

// Names in the order in which they appear first, with their positions.
struct Names {
  std::vector<std::string> list;
  std::map<std::string, size_t> place;
  void add(const std::string& name) {
    if (place.emplace(name, list.size()).second) list.push_back(name);
  }
};

std::string joined(const std::set<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + quoted(name);
  return out;
}

std::string caption_of(const std::vector<const MatrixRow*>& rows, const HeatTable& table) {
  std::set<std::string> runs;
  for (const MatrixRow* row : rows)
    if (!row->run.empty()) runs.insert(row->run);
  int64_t fewest = INT64_MAX, most = 0;
  for (const HeatCell& cell : table.cells)
    if (cell.evaluated()) {
      fewest = std::min(fewest, cell.episodes);
      most = std::max(most, cell.episodes);
    }
  std::string out = rows.front()->method;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : ", ") + text; };
  const int64_t window = rows.front()->window;
  if (window != 1) add(window == 0 ? "blind" : concat("window radius ", window));
  if (!runs.empty()) add(counted(int64_t(runs.size()), "run"));
  if (most > 0)
    add(fewest == most ? counted(most, "episode") + " a pair" : concat(fewest, " to ", most, " episodes a pair"));
  return out;
}

std::string hundredths_text(int64_t hundredths) {
  char text[16];
  std::snprintf(text, sizeof text, "%d.%02d", int(hundredths / 100), int(hundredths % 100));
  return text;
}

}  // namespace

void HeatMean::add(const HeatCell& cell) {
  if (!cell.evaluated()) return;
  each = pairs == 0 || each == cell.episodes ? cell.episodes : -1;
  ++pairs;
  episodes += cell.episodes;
  successes += cell.successes;
  rates += cell.rate();
}

HeatTable pool_matrix(const Matrix& matrix, const std::string& method, bool by_part) {
  std::vector<const MatrixRow*> rows;
  std::set<std::string> methods;
  std::set<std::pair<std::string, int64_t>> worlds;  // with the window
  Names envs, tasks;
  std::set<std::string> part_names, temperatures;
  for (const MatrixRow& row : matrix.rows) {
    if (!method.empty() && row.method != method) continue;
    rows.push_back(&row);
    methods.insert(row.method);
    worlds.emplace(row.world, row.window);
    temperatures.insert(row.temperature ? shortest(*row.temperature) : "not known");
    envs.add(row.env);
    tasks.add(row.task);
    if (!row.part.empty()) part_names.insert(row.part);
  }
  if (rows.empty()) fail(Exit::kData, "no row", method.empty() ? "" : " of the method " + quoted(method));
  if (methods.size() > 1) fail(Exit::kData, kSeveralMethods, "rows of several methods (", joined(methods), ")");
  if (worlds.size() > 1) {
    std::set<std::string> names;
    for (const auto& [world, window] : worlds) names.insert(concat(world, " with window ", window));
    fail(Exit::kData, "rows of several worlds (", joined(names), "): draw them one by one");
  }
  if (temperatures.size() > 1)
    fail(Exit::kData, "rows of several temperatures (", joined(temperatures), "): draw them one by one");
  if (const std::string env = mixed_environment(rows); !env.empty())
    fail(Exit::kData, "the environment ", quoted(env),
         " is not the same in all rows (env_hash): other ones go by its name, draw the runs one by one");
  if (by_part && part_names.empty()) fail(Exit::kData, "no column part to colour by");
  if (const size_t side = std::max(tasks.list.size(), envs.list.size()); side > kMostHeatNames)
    fail(Exit::kData, side, tasks.list.size() == side ? " tasks" : " environments", ": expected at most ",
         kMostHeatNames);
  if (envs.list.size() * tasks.list.size() > kMostHeatCells)
    fail(Exit::kData, tasks.list.size(), " tasks x ", envs.list.size(), " environments: expected at most ",
         kMostHeatCells, " cells");

  HeatTable table;
  table.envs = envs.list;
  table.tasks = tasks.list;
  table.cells.resize(envs.list.size() * tasks.list.size());
  table.by_part = by_part;
  for (const std::string& name : part_names) table.parts.emplace_back(name);
  std::vector<HeatGroup> groups;
  if (by_part) {
    groups = table.parts;
    groups.emplace_back("unnamed");
  } else {
    for (const Standing standing : {Standing::kSeen, Standing::kUnseen, Standing::kNew})
      groups.emplace_back(name_of(standing));
  }
  for (const MatrixRow* row : rows) {
    HeatCell& cell = table.cells[tasks.place[row->task] * envs.list.size() + envs.place[row->env]];
    const int part = row->part.empty() ? -1 : int(std::distance(part_names.begin(), part_names.find(row->part)));
    const int group = !by_part ? int(row->standing()) : part >= 0 ? part : int(groups.size()) - 1;
    const auto differs = [&](const std::string& how) {
      fail(Exit::kData, "the pair ", quoted(row->env), " ", quoted(row->task), " ", how, ": draw the runs one by one");
    };
    if (cell.group >= 0 && cell.part != part) differs("is in different parts in two rows");
    if (cell.group >= 0 && cell.group != group)
      differs(by_part ? "is in a part in one row and in none in another"
                      : concat("is ", groups[cell.group].name, " in one row and ", groups[group].name, " in another"));
    cell.group = group;
    cell.part = part;
    cell.episodes += row->episodes;
    cell.successes += row->successes;
  }

  std::vector<bool> occurs(groups.size());
  for (const HeatCell& cell : table.cells) {
    if (cell.group < 0) continue;
    occurs[cell.group] = true;
    groups[cell.group].add(cell);
    ++groups[cell.group].members;
    if (cell.part < 0) continue;
    table.parts[cell.part].add(cell);
    ++table.parts[cell.part].members;
  }
  table.split = std::none_of(rows.begin(), rows.end(), [](const MatrixRow* row) { return row->episodes > 0; });
  std::vector<int> renumbered(groups.size(), -1);
  for (size_t i = 0; i < groups.size(); ++i)
    if (occurs[i]) {
      renumbered[i] = int(table.groups.size());
      table.groups.push_back(groups[i]);
    }
  for (HeatCell& cell : table.cells)
    if (cell.group >= 0) cell.group = renumbered[cell.group];
  table.caption = caption_of(rows, table);
  return table;
}

int64_t whole_percent(int64_t successes, int64_t episodes) {
  return whole_percent(100.0 * double(successes) / double(episodes), successes > 0, successes < episodes);
}

std::string rate_text(int64_t successes, int64_t episodes) {
  return hundredths_text(whole_percent(successes, episodes));
}

std::string rate_text(const HeatMean& mean) {
  if (mean.each >= 0) return rate_text(mean.successes, mean.episodes);
  return hundredths_text(whole_percent(100.0 * mean.mean(), mean.successes > 0, mean.successes < mean.episodes));
}

}  // namespace synpo
