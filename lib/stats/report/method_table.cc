#include "stats/report/method_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "format/tsv.h"

namespace synpo {
namespace {

// A bootstrap of n values is too narrow by about sqrt((n - 1) / n), and its percentiles by more.
constexpr int64_t kFewRuns = 10;

// Means of values in rising order, so that the order of the rows does not count.
MeanSd mean_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return mean_sd(values);
}

TableCell cell_of(const Group& group, const std::string& subset, const MeasureKind& measure,
                  const std::optional<BootstrapPlan>& bootstrap) {
  TableCell cell;
  std::map<std::string, std::vector<double>> of_pair;  // a value for each run
  std::vector<double> means, all;
  int64_t episodes_of_first = 0;
  bool level = true;     // as many episodes of every pair
  double variances = 0;  // of the mean, in units of that of a single episode
  for (const Run& run : group.runs) {
    std::vector<double> of_run;
    double sum = 0;
    for (const PairTally& pair : run.pairs) {
      if (!belongs(pair, subset)) continue;
      of_run.push_back(measure.value(pair.tally));
      of_pair[pair.name()].push_back(of_run.back());
      if (cell.episodes == 0) episodes_of_first = pair.tally.episodes;
      level &= pair.tally.episodes == episodes_of_first;
      cell.episodes += pair.tally.episodes;
      sum += 1 / double(pair.tally.episodes);
    }
    if (of_run.empty()) continue;
    const double pairs = double(of_run.size());
    variances += sum / pairs / pairs;
    all.insert(all.end(), of_run.begin(), of_run.end());
    means.push_back(mean_of(std::move(of_run)).mean);
  }
  const double runs = double(means.size());
  cell.runs = int64_t(means.size());
  cell.pairs = int64_t(of_pair.size());
  cell.over_runs = mean_of(std::move(means));
  cell.iqm = interquartile_mean(std::move(all));
  cell.interval = {NAN, NAN};
  if (std::isnan(cell.over_runs.mean)) return cell;
  if (bootstrap && cell.runs > 1) {
    std::vector<std::vector<double>> values;
    for (auto& [name, of_runs] : of_pair) {
      std::sort(of_runs.begin(), of_runs.end());
      values.push_back(std::move(of_runs));
    }
    cell.interval = stratified_bootstrap(values, *bootstrap);
  } else {
    cell.interval = student(cell.over_runs);
  }
  if (!measure.rate) return cell;
  const bool unknown = std::isnan(cell.interval.low);
  if (unknown && !level) return cell;
  const double mean = std::clamp(cell.over_runs.mean, 0.0, 1.0);
  const Interval least = wilson_of_rate(mean, runs * runs / variances);
  cell.wilson = unknown || (least.low <= cell.interval.low && cell.interval.high <= least.high);
  cell.interval = hull(cell.interval, least);
  cell.interval = {std::max(0.0, cell.interval.low), std::min(1.0, cell.interval.high)};
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
  if (several([&](const Group& other) { return other.temperature != group.temperature; }))
    label += group.temperature ? ", temperature " + shortest(*group.temperature) : ", temperature not known";
  return label;
}

}  // namespace

MethodTable tabulate(const Matrix& matrix, const std::vector<std::string>& subsets, const MeasureKind& measure,
                     const std::optional<BootstrapPlan>& bootstrap) {
  MethodTable table{&measure, subsets, {}, bootstrap, mixed_environment(matrix)};
  const std::vector<Group> groups = group_runs(matrix);
  for (const Group& group : groups) {
    TableLine line{label_of(group, groups), group.world, group.method, group.window, group.temperature, {}};
    for (const std::string& subset : subsets) line.cells.push_back(cell_of(group, subset, measure, bootstrap));
    table.lines.push_back(std::move(line));
  }
  return table;
}

std::string method_table_text(const MethodTable& table, TableFormat format, bool brief) {
  const MeasureKind& kind = *table.measure;
  std::vector<std::vector<std::string>> rows = {{"method", "runs"}};
  for (const std::string& subset : table.subsets) {
    rows[0].push_back(subset + (kind.rate ? " %" : ""));
    if (!brief) rows[0].insert(rows[0].end(), {"95 % interval", "IQM"});
  }
  bool spread = false, starred = false, over_runs = false, few = false;
  for (const TableLine& line : table.lines) {
    int64_t runs = 0;
    for (const TableCell& cell : line.cells) runs = std::max(runs, cell.runs);
    std::vector<std::string> row = {line.label, std::to_string(runs)};
    for (const TableCell& cell : line.cells) {
      const double mean = cell.over_runs.mean;
      const int digits = brief ? kind.digits : range_digits(cell.interval, mean, kind);
      row.push_back(spread_text(cell.over_runs, kind, digits));
      spread |= cell.runs > 1;
      if (brief) continue;
      row.push_back(range_text(cell.interval, mean, kind) + (cell.wilson ? " w" : ""));
      row.push_back(kind.rate ? percent(cell.iqm, kind.digits) : decimal(cell.iqm, kind.digits));
      starred |= cell.wilson;
      const bool told = !cell.wilson && !std::isnan(cell.interval.low);
      over_runs |= told;
      few |= told && cell.runs < kFewRuns;
    }
    rows.push_back(std::move(row));
  }
  std::string words =
      concat(kind.name, kind.rate ? " in per cent of the episodes" : " per episode", ", every pair alike.\n");
  if (spread)
    words += "a +- b: mean and standard deviation over runs (divisor: runs - 1); alike: all runs have this value.\n";
  if (over_runs && table.bootstrap)
    words += concat("Interval: of the mean, over runs, on these pairs: bootstrap, runs drawn in each pair on its own, ",
                    table.bootstrap->samples, " samples, seed ", table.bootstrap->seed,
                    few ? "; of so few runs it is too narrow.\n" : ".\n");
  else if (over_runs)
    words += concat("Interval: of the mean, over runs, on these pairs: what other seeds would do; Student's t",
                    kind.rate ? ", never narrower than w.\n" : ".\n");
  if (starred)
    words +=
        "w: Wilson's interval for k of n, over episodes alone: one run, or runs as alike as these, say nothing of "
        "others.\n";
  if (!table.mixed_env.empty())
    words += concat("The environment ", quoted(table.mixed_env),
                    " is not the same in all runs (env_hash): other ones go by its name.\n");
  if (!brief) words += "IQM: interquartile mean of the values of all runs and pairs.\n";
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
                           "iqm", "low", "high", "interval", "temperature"})
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
      writer.text(std::isnan(cell.interval.low) ? "NA"
                  : cell.wilson                 ? "wilson"
                  : table.bootstrap             ? "bootstrap"
                                                : "student");
      writer.real(line.temperature.value_or(NAN)).end_row();
    }
  }
}

}  // namespace synpo
