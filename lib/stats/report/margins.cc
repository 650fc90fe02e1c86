#include "stats/report/margins.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "format/tsv.h"
#include "stats/interval.h"
#include "stats/matrix/runs.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

const MeasureKind& success() { return find_measure("success"); }

std::vector<Margin> margins_of(const Group& group, Axis axis) {
  std::vector<Margin> margins;
  std::unordered_map<std::string, size_t> place;
  // A line's pairs, over all runs, in the order of the matrix.
  std::vector<std::vector<std::pair<std::string, Tally>>> across;
  std::unordered_map<std::string, size_t> pair_place;
  for (const Run& run : group.runs) {
    for (const PairTally& pair : run.pairs) {
      const std::string& name = axis == Axis::kTasks ? pair.task : pair.env;
      const auto [at, fresh] = place.try_emplace(name, margins.size());
      if (fresh) {
        margins.push_back({name, 0, {}, {}, {}, {}, "", {}});
        across.emplace_back();
      }
      Margin& margin = margins[at->second];
      margin.all.add(pair.tally);
      (pair.standing == Standing::kSeen     ? margin.seen
       : pair.standing == Standing::kUnseen ? margin.unseen
                                            : margin.new_pairs)
          .add(pair.tally);
      auto& pairs = across[at->second];
      const auto [at_pair, fresh_pair] = pair_place.try_emplace(pair.name(), pairs.size());
      if (fresh_pair) pairs.push_back({axis == Axis::kTasks ? pair.env : pair.task, {}});
      pairs[at_pair->second].second.add(pair.tally);
    }
  }
  for (size_t i = 0; i < margins.size(); ++i) {
    margins[i].pairs = int64_t(across[i].size());
    const auto worst = std::min_element(across[i].begin(), across[i].end(), [](const auto& a, const auto& b) {
      return success().value(a.second) < success().value(b.second);
    });
    margins[i].worst = worst->first;
    margins[i].worst_tally = worst->second;
  }
  std::stable_sort(margins.begin(), margins.end(),
                   [](const Margin& a, const Margin& b) { return a.rate() < b.rate(); });
  return margins;
}

}  // namespace

std::vector<GroupMargins> margins(const Matrix& matrix, Axis axis) {
  if (const std::string env = mixed_environment(matrix); !env.empty())
    fail(Exit::kData, "the environment ", quoted(env),
         " is not the same in all rows (env_hash): other ones go by its name, look at the runs one by one");
  std::vector<GroupMargins> all;
  for (Group& group : group_runs(matrix)) {
    std::vector<Margin> lines = margins_of(group, axis);
    all.push_back({std::move(group), std::move(lines)});
  }
  return all;
}

std::string margins_text(const std::vector<GroupMargins>& groups, Axis axis, size_t most) {
  const bool tasks = axis == Axis::kTasks;
  std::string text;
  const bool any_new = std::any_of(groups.begin(), groups.end(), [](const GroupMargins& group) {
    return std::any_of(group.margins.begin(), group.margins.end(),
                       [](const Margin& margin) { return margin.new_pairs.episodes > 0; });
  });
  for (const GroupMargins& group : groups) {
    std::vector<std::vector<std::string>> rows = {{tasks ? "task" : "env", tasks ? "worst env" : "worst task", "%",
                                                   "pairs", "k of n", "success %", "95 % interval", "seen %",
                                                   "unseen %"}};
    if (any_new) rows[0].push_back("new %");
    for (size_t i = 0; i < group.margins.size() && i < most; ++i) {
      const Margin& m = group.margins[i];
      const auto rate = [](const Tally& tally) { return percent(success().value(tally)); };
      const Interval interval = wilson(m.all.successes, m.all.episodes);
      rows.push_back({m.name, m.worst, rate(m.worst_tally), std::to_string(m.pairs),
                      concat(m.all.successes, " of ", m.all.episodes),
                      percent(m.rate(), range_digits(interval, m.rate(), success())),
                      range_text(interval, m.rate(), success()), rate(m.seen), rate(m.unseen)});
      if (any_new) rows.back().push_back(rate(m.new_pairs));
    }
    text += heading(group.group) + '\n' + table_text(rows, TableFormat::kText, 2) + '\n';
  }
  return text + concat("worst first; k of n: successes of episodes, over ", tasks ? "environments" : "tasks",
                       " and runs; interval: Wilson's, for k of n, over episodes.\n");
}

void write_margins(Output& output, const std::vector<GroupMargins>& groups, Axis axis, size_t most) {
  const bool tasks = axis == Axis::kTasks;
  TsvWriter writer(output);
  for (const char* name :
       {"world", "window", "method", tasks ? "task" : "env", "runs", "pairs", "episodes", "successes", "success",
        "success_low", "success_high", "success_seen", "success_unseen", "reward", "length",
        tasks ? "worst_env" : "worst_task", "worst_success", "success_new", "temperature"})
    writer.text(name);
  writer.end_row();
  for (const GroupMargins& group : groups) {
    for (size_t i = 0; i < group.margins.size() && i < most; ++i) {
      const Margin& m = group.margins[i];
      const Interval interval = wilson(m.all.successes, m.all.episodes);
      writer.text(group.group.world).whole(group.group.window).text(group.group.method).text(m.name);
      writer.whole(int64_t(group.group.runs.size())).whole(m.pairs).whole(m.all.episodes).whole(m.all.successes);
      writer.real(m.rate())
          .real(interval.low)
          .real(interval.high)
          .real(success().value(m.seen))
          .real(success().value(m.unseen));
      writer.real(find_measure("reward").value(m.all)).real(find_measure("length").value(m.all));
      writer.text(m.worst).real(success().value(m.worst_tally)).real(success().value(m.new_pairs));
      writer.real(group.group.temperature.value_or(NAN)).end_row();
    }
  }
}

}  // namespace synpo
