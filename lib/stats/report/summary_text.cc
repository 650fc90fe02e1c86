#include <cmath>

#include "base/error.h"
#include "format/tsv.h"
#include "stats/matrix/runs.h"
#include "stats/report/summary.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

// "7.12", with several runs "7.12 +- 0.10".
std::string cell(const Measure& measure, const char* kind, bool several) {
  const MeasureKind& shown = find_measure(kind);
  if (several) return spread_text(measure.over_runs, shown);
  return shown.rate ? percent(measure.pooled, shown.digits) : decimal(measure.pooled, shown.digits);
}

}  // namespace

std::string summary_text(const std::vector<GroupSummary>& groups, const PaintName& paint) {
  std::string text;
  bool any_several = false;
  const MeasureKind& success = find_measure("success");
  for (const GroupSummary& group : groups) {
    const bool several = group.runs > 1;
    any_several |= several;
    std::vector<std::vector<std::string>> rows = {{"", "pairs", "k of n", "success %", "95 % interval"}};
    if (several) rows[0].push_back("over runs");
    rows[0].insert(rows[0].end(), {"reward", "length", "wrong %", "timeouts %"});
    for (const SubsetSummary& subset : group.subsets) {
      const double rate = subset.success.pooled;
      std::vector<std::string> row = {
          subset.name, std::to_string(subset.pairs), concat(subset.successes, " of ", subset.episodes),
          percent(rate, range_digits(subset.interval, rate, success)), range_text(subset.interval, rate, success)};
      if (several) row.push_back(cell(subset.success, "success", true));
      row.push_back(cell(subset.reward, "reward", several));
      row.push_back(cell(subset.length, "length", several));
      row.push_back(cell(subset.wrong, "wrong", several));
      row.push_back(cell(subset.timeouts, "timeouts", several));
      rows.push_back(std::move(row));
    }
    text += group.heading + '\n';
    std::string table = table_text(rows);
    size_t line = 0;
    for (size_t i = 0; paint && i < group.subsets.size(); ++i) {
      line = table.find('\n', line) + 1;
      const std::string& name = group.subsets[i].name;
      table.replace(line, name.size(), paint(group.subsets[i], name));
    }
    text += table + '\n';
  }
  text += "k of n: successes of episodes, all pairs and runs together.\n";
  text += "Interval: Wilson's, for k of n, over episodes: what these runs would do again on these pairs.\n";
  text += "reward and length: per episode; wrong and timeouts: share of the episodes.\n";
  if (any_several)
    text +=
        "a +- b: mean and standard deviation (divisor: runs - 1) of the runs' own values; alike: all have this "
        "value.\n";
  return text;
}

void write_summary(Output& output, const std::vector<GroupSummary>& groups) {
  TsvWriter writer(output);
  for (const char* name : {"world", "window", "method", "least_updates", "most_updates", "subset", "runs", "pairs",
                           "episodes", "successes", "success_low", "success_high", "success_pair_mean"})
    writer.text(name);
  for (const char* name : {"success", "reward", "length", "wrong", "timeouts"})
    writer.text(name).text(concat(name, "_run_mean")).text(concat(name, "_run_sd"));
  writer.text("temperature").end_row();
  for (const GroupSummary& group : groups) {
    for (const SubsetSummary& subset : group.subsets) {
      writer.text(group.world)
          .whole(group.window)
          .text(group.method)
          .whole(group.least_updates)
          .whole(group.most_updates);
      writer.text(subset.name).whole(subset.runs).whole(subset.pairs).whole(subset.episodes).whole(subset.successes);
      writer.real(subset.interval.low).real(subset.interval.high).real(subset.pair_mean);
      for (const Measure* measure : {&subset.success, &subset.reward, &subset.length, &subset.wrong, &subset.timeouts})
        writer.real(measure->pooled).real(measure->over_runs.mean).real(measure->over_runs.sd);
      writer.real(group.temperature.value_or(NAN)).end_row();
    }
  }
}

}  // namespace synpo
