#include "render/curve_data.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files/io.h"
#include "base/text.h"
#include "stats/curve.h"

using namespace synpo;

namespace {

constexpr char kPolicyLoss[] = "policy";
// A log with this column is of a training that plays: its columns success and reward are of the episodes that ended.
constexpr char kEpisodes[] = "episodes";

struct Log {
  std::string path;
  RunLogTable table;  // others: the measure's own column, the loss of the policy, episodes
};

Curve curve_of(const RunLogTable& table, const std::vector<double>& values, double unit, bool percent) {
  Curve curve;
  for (size_t i = 0; i < values.size(); ++i)
    if (!std::isnan(values[i])) {
      curve.x.push_back(table.x[i] * unit);
      curve.y.push_back(percent ? 100 * values[i] : values[i]);
    }
  return curve;
}

bool has_values(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
}

}  // namespace

Measure find_measure(const std::string& name, const std::string& pairs) {
  if (name == "success" || name == "reward") {
    const bool success = name == "success";
    const std::string title = success ? "success (%)" : "reward of an episode";
    if (pairs == "training") return {{name}, {""}, title + " in training", success, "", true};
    Measure measure{{}, {}, title, success, name};
    for (const std::string part : {"seen", "unseen"})
      if (pairs == "both" || pairs == part) {
        measure.columns.push_back(part + "_" + name);
        measure.parts.push_back(part);
      }
    return measure;
  }
  static const Measure known[] = {
      {{"loss"}, {}, "loss", false},
      {{"learning_rate"}, {}, "learning rate", false},
      {{"states_per_s"}, {}, "states per second", false},
      {{"policy"}, {}, "policy loss (nats)", false},
      {{"env"}, {}, "environment loss (nats)", false},
      {{"task"}, {}, "task loss (nats)", false},
      {{"right_move"}, {}, "right moves (%)", true},
      {{"right_pick"}, {}, "right picks (%)", true},
      {{"right_walk_on"}, {}, "right walking on (%)", true},
      {{"right_start"}, {}, "right starts (%)", true},
      {{"wrong"}, {}, "wrong picks (%)", true},
  };
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  Measure measure{{name == "reward_loss" ? "reward" : name}, {}, title, false};
  for (const Measure& candidate : known)
    if (candidate.columns[0] == name) measure = candidate;
  measure.parts = {""};
  return measure;
}

CurveData read_curve_data(const CurveRequest& request) {
  // What lets the columns of the measure be missing: that the training plays, or that this is about to be looked at.
  const std::string instead = request.measure.of_training ? "update" : request.measure.own.empty() ? "" : kEpisodes;
  std::vector<std::vector<Log>> methods;
  for (const LabelledFiles& method : request.logs) {
    methods.emplace_back();
    for (const std::string& path : method.paths) {
      Input input(path);
      methods.back().push_back(
          {input.name(), read_run_log(input, request.axis, request.measure.columns,
                                      {request.measure.own, kPolicyLoss, kEpisodes}, request.growing, instead)});
    }
  }
  for (const std::vector<Log>& logs : methods)
    for (const Log& log : logs)
      if (request.measure.of_training && log.table.others[2].empty())
        fail(Exit::kData, log.path, ": line 1: no column '", kEpisodes, "': this training played no episodes");
  const auto all = [&](auto&& holds) {
    return std::all_of(methods.begin(), methods.end(),
                       [&](const std::vector<Log>& logs) { return std::all_of(logs.begin(), logs.end(), holds); });
  };
  const auto evaluated = [](const Log& log) {
    return std::any_of(log.table.columns.begin(), log.table.columns.end(), has_values);
  };
  const auto plays = [](const Log& log) { return has_values(log.table.others[0]) && !log.table.others[2].empty(); };
  const auto has_loss = [](const Log& log) { return has_values(log.table.others[1]); };

  CurveData data{{}, request.measure, ""};
  const Measure& asked = request.measure;
  const bool nothing = all([&](const Log& log) { return !evaluated(log); });
  int other = -1;
  if (nothing && !asked.own.empty() && all(plays)) {
    other = 0;
    data.measure = find_measure(asked.own, "training");
    data.note = "nothing was evaluated: this is of the episodes that the training played";
  } else if (nothing && request.any && all(has_loss)) {
    other = 1;
    data.measure = find_measure(kPolicyLoss, "");
    data.note = "nothing was evaluated: this is the loss of the policy";
  }
  for (size_t i = 0; i < methods.size(); ++i) {
    data.methods.push_back({request.logs[i].label, {}});
    for (const Log& log : methods[i]) {
      const size_t rows = log.table.x.size();
      if (other < 0 && !evaluated(log))
        fail(Exit::kData, log.path, ": no value of ", request.name, " in ", counted(int64_t(rows), "row"),
             asked.parts[0].empty() ? "" : ": the run made no evaluation");
      std::vector<Curve> curves;
      const auto add = [&](const std::vector<double>& values) {
        curves.push_back(curve_of(log.table, values, request.unit, data.measure.percent));
      };
      if (other >= 0)
        add(log.table.others[size_t(other)]);
      else
        for (const std::vector<double>& column : log.table.columns) add(column);
      data.methods.back().runs.push_back(std::move(curves));
    }
  }
  return data;
}
