#include "stats/report/method_table.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "format/tsv.h"

namespace synpo {
namespace {

// A bootstrap of n values is too narrow by about sqrt((n - 1) / n), and its percentiles by more.
constexpr int64_t kFewRuns = 10;

TableCell cell_of(const Group& group, const std::string& subset, const MeasureKind& measure,
                  const BootstrapPlan& plan) {
  TableCell cell;
  PairValues values;
  std::unordered_map<std::string, size_t> place;
  std::vector<double> means, all;
  int64_t k = 0, episodes_of_first = 0;
  bool alike = true;  // as many episodes of every pair, so that k in n is the mean
  for (size_t r = 0; r < group.runs.size(); ++r) {
    std::vector<double> of_run;
    for (const PairTally& pair : group.runs[r].pairs) {
      if (!belongs(pair, subset)) continue;
      const auto [at, fresh] = place.try_emplace(pair.name(), values.size());
      if (fresh) values.emplace_back();
      of_run.push_back(measure.value(pair.tally));
      values[at->second].push_back({uint32_t(r), of_run.back()});
      if (cell.episodes == 0) episodes_of_first = pair.tally.episodes;
      alike &= pair.tally.episodes == episodes_of_first;
      cell.episodes += pair.tally.episodes;
      if (measure.count) k += measure.count(pair.tally);
    }
    if (of_run.empty()) continue;
    means.push_back(mean_sd(of_run).mean);
    all.insert(all.end(), of_run.begin(), of_run.end());
  }
  cell.runs = int64_t(means.size());
  cell.pairs = int64_t(values.size());
  cell.over_runs = mean_sd(means);
  cell.iqm = interquartile_mean(std::move(all));
  cell.interval = {NAN, NAN};
  if (std::isnan(cell.over_runs.mean)) return cell;
  cell.interval = bootstrap_mean(values, group.runs.size(), plan);
  if (std::isnan(cell.interval.low) && measure.count && alike) {
    cell.interval = wilson(k, cell.episodes);
    cell.wilson = true;
  }
  return cell;
}

std::string label_of(const Group& group, const std::vector<Group>& groups) {
  const auto several = [&](auto differs) {
    return std::any_of(groups.begin(), groups.end(),
                       [&](const Group& other) { return other.method == group.method && differs(other); });
  };
  std::string label = group.method.empty() ? "unnamed" : group.method;
  if (several([&](const Group& other) { return other.world != group.world; }))
    label += ", " + (group.world.empty() ? "unnamed world" : group.world);
  if (several([&](const Group& other) { return other.window != group.window; }))
    label += concat(", window ", group.window);
  return label;
}

}  // namespace

MethodTable tabulate(const Matrix& matrix, const std::vector<std::string>& subsets, const MeasureKind& measure,
                     const BootstrapPlan& plan) {
  MethodTable table{&measure, subsets, {}, plan};
  const std::vector<Group> groups = gather(matrix);
  for (const Group& group : groups) {
    TableLine line{label_of(group, groups), group.world, group.method, group.window, {}};
    for (const std::string& subset : subsets) line.cells.push_back(cell_of(group, subset, measure, plan));
    table.lines.push_back(std::move(line));
  }
  return table;
}

std::string method_table_text(const MethodTable& table, TableFormat format, bool brief) {
  const MeasureKind& kind = *table.measure;
  std::vector<std::vector<std::string>> rows = {{"method", "runs"}};
  for (const std::string& subset : table.subsets) {
    rows[0].push_back(subset + (kind.rate ? " %" : ""));
    if (!brief) rows[0].insert(rows[0].end(), {"IQM", "95 % interval"});
  }
  bool spread = false, starred = false, resampled = false, few = false;
  for (const TableLine& line : table.lines) {
    int64_t runs = 0;
    for (const TableCell& cell : line.cells) runs = std::max(runs, cell.runs);
    std::vector<std::string> row = {line.label, std::to_string(runs)};
    for (const TableCell& cell : line.cells) {
      row.push_back(spread_text(cell.over_runs, kind));
      spread |= cell.runs > 1;
      if (brief) continue;
      row.push_back(kind.rate ? percent(cell.iqm, kind.digits) : decimal(cell.iqm, kind.digits));
      row.push_back(range_text(cell.interval, kind) + (cell.wilson ? " w" : ""));
      starred |= cell.wilson;
      const bool drawn = !cell.wilson && !std::isnan(cell.interval.low);
      resampled |= drawn;
      few |= drawn && cell.runs < kFewRuns;
    }
    rows.push_back(std::move(row));
  }
  std::string words =
      concat(kind.name, kind.rate ? " in per cent of the episodes" : " per episode", ", every pair alike.\n");
  if (spread)
    words += "a +- b: mean and standard deviation over runs (divisor: runs - 1); alike: all runs have this value.\n";
  if (!brief) words += "IQM: interquartile mean of the values of all runs and pairs.\n";
  if (resampled)
    words += concat("Interval: bootstrap over runs, drawn ",
                    table.plan.pair_by_pair ? "in each pair on its own" : "whole", ", ", table.plan.samples,
                    " samples, seed ", table.plan.seed, few ? "; of so few runs it is too narrow.\n" : ".\n");
  if (starred) words += "w: Wilson's interval for k of n: one run, or runs all alike, tell nothing of other runs.\n";
  if (format == TableFormat::kMarkdown)
    if (const size_t at = words.find("+-"); at != std::string::npos) words.replace(at, 2, "\xc2\xb1");
  if (format != TableFormat::kLatex) return table_text(rows, format) + '\n' + words;
  std::string comment;
  for (size_t at = 0, end; at < words.size(); at = end + 1) {
    end = words.find('\n', at);
    comment += "% " + words.substr(at, end - at) + '\n';
  }
  return comment + table_text(rows, format);
}

void write_method_table(Output& output, const MethodTable& table) {
  TsvWriter writer(output);
  for (const char* name : {"world", "window", "method", "subset", "measure", "runs", "pairs", "episodes", "mean", "sd",
                           "iqm", "low", "high", "interval"})
    writer.text(name);
  writer.end_row();
  for (const TableLine& line : table.lines) {
    for (size_t i = 0; i < line.cells.size(); ++i) {
      const TableCell& cell = line.cells[i];
      writer.text(line.world).whole(line.window).text(line.method).text(table.subsets[i]).text(table.measure->name);
      writer.whole(cell.runs)
          .whole(cell.pairs)
          .whole(cell.episodes)
          .real(cell.over_runs.mean)
          .real(cell.over_runs.sd)
          .real(cell.iqm);
      writer.real(cell.interval.low).real(cell.interval.high);
      writer.text(std::isnan(cell.interval.low) ? "NA" : cell.wilson ? "wilson" : "bootstrap").end_row();
    }
  }
}

}  // namespace synpo
