#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "format/tsv.h"
#include "stats/summary.h"

namespace synpo {
namespace {

std::string decimal(double value, int digits) {
  if (std::isnan(value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// "7.12", with several runs "7.12 +- 0.10".
std::string cell(const Measure& measure, double scale, int digits, bool several) {
  if (!several) return decimal(measure.pooled * scale, digits);
  if (std::isnan(measure.over_runs.sd)) return decimal(measure.over_runs.mean * scale, digits);
  return decimal(measure.over_runs.mean * scale, digits) + " +- " + decimal(measure.over_runs.sd * scale, digits);
}

// The first column to the left, the others to the right, two blanks between.
std::string align(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      text += i == 0 ? row[i] + blanks : "  " + blanks + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string heading(const GroupSummary& group) {
  std::string text = group.method.empty() ? "unnamed method" : group.method;
  if (!group.world.empty()) text += concat(" on ", group.world, ", window ", group.window);
  if (group.most_updates > 0) {
    text += concat(", ", group.least_updates);
    if (group.most_updates > group.least_updates) text += concat(" to ", group.most_updates);
    text += " updates";
  }
  text += concat(": ", group.seeds.size(), group.seeds.size() == 1 ? " run (seed" : " runs (seeds");
  for (size_t i = 0; i < group.seeds.size() && i < 20; ++i) text += concat(' ', group.seeds[i]);
  return text + (group.seeds.size() > 20 ? " ...)\n" : ")\n");
}

}  // namespace

std::string summary_text(const std::vector<GroupSummary>& groups) {
  std::string text;
  bool any_several = false;
  for (const GroupSummary& group : groups) {
    const bool several = group.seeds.size() > 1;
    any_several |= several;
    std::vector<std::vector<std::string>> rows = {{"", "pairs", "k of n", "success %", "95 % interval"}};
    if (several) rows[0].push_back("over runs");
    rows[0].insert(rows[0].end(), {"reward", "length", "wrong %", "timeouts %"});
    for (const SubsetSummary& subset : group.subsets) {
      const bool none = subset.episodes == 0;
      std::vector<std::string> row = {subset.name, std::to_string(subset.pairs), concat(subset.successes, " of ", subset.episodes),
                                      decimal(subset.success.pooled * 100, 1),
                                      none ? "-" : decimal(subset.interval.low * 100, 1) + " to " + decimal(subset.interval.high * 100, 1)};
      if (several) row.push_back(cell(subset.success, 100, 1, true));
      row.push_back(cell(subset.reward, 1, 2, several));
      row.push_back(cell(subset.length, 1, 1, several));
      row.push_back(cell(subset.wrong, 100, 1, several));
      row.push_back(cell(subset.timeouts, 100, 1, several));
      rows.push_back(std::move(row));
    }
    text += heading(group) + align(rows) + '\n';
  }
  text += "k of n: successes of episodes, all pairs and runs together; interval: Wilson's, for k of n.\n";
  text += "reward and length: per episode; wrong and timeouts: share of the episodes.\n";
  if (any_several) text += "a +- b: mean and standard deviation (divisor: runs - 1) of the runs' own values.\n";
  return text;
}

void write_summary(Output& output, const std::vector<GroupSummary>& groups) {
  TsvWriter writer(output);
  for (const char* name : {"world", "window", "method", "least_updates", "most_updates", "subset", "runs", "pairs", "episodes",
                           "successes", "success_low", "success_high", "success_pair_mean"})
    writer.text(name);
  for (const char* name : {"success", "reward", "length", "wrong", "timeouts"})
    writer.text(name).text(concat(name, "_run_mean")).text(concat(name, "_run_sd"));
  writer.end_row();
  for (const GroupSummary& group : groups) {
    for (const SubsetSummary& subset : group.subsets) {
      const bool none = subset.episodes == 0;
      writer.text(group.world).whole(group.window).text(group.method).whole(group.least_updates).whole(group.most_updates);
      writer.text(subset.name).whole(subset.runs).whole(subset.pairs).whole(subset.episodes).whole(subset.successes);
      writer.real(none ? NAN : subset.interval.low).real(none ? NAN : subset.interval.high).real(subset.pair_mean);
      for (const Measure* measure : {&subset.success, &subset.reward, &subset.length, &subset.wrong, &subset.timeouts})
        writer.real(measure->pooled).real(measure->over_runs.mean).real(measure->over_runs.sd);
      writer.end_row();
    }
  }
}

}  // namespace synpo
