#include <algorithm>
#include <cstddef>
#include <limits>

#include "base/error.h"
#include "format/run_log.h"
#include "format/tsv.h"

namespace synpo {
namespace {

bool is_rate(const std::string& column) {
  return column.ends_with("success") || column.starts_with("right_") || column == "wrong";
}

double value(const TsvReader& reader, int column) {
  const std::string& name = reader.columns()[column];
  if (reader.field(column) == "NA") return std::numeric_limits<double>::quiet_NaN();
  double found = 0;
  try {
    found = reader.real(column);
  } catch (const Error&) {
    reader.bad(column, is_rate(name) ? "a rate from 0 to 1, or NA" : "a finite number, or NA");
  }
  if (is_rate(name) && (found < 0 || found > 1)) reader.bad(column, "a rate from 0 to 1, or NA");
  return found;
}

// Seconds of training, over all processes that wrote the log.
class Clock {
 public:
  explicit Clock(const TsvReader& reader)
      : reader_(reader), seconds_(reader.need("seconds")), rate_(reader.need("states_per_s")) {}

  // The seconds at the reader's row, given the states and the seconds of the row kept before it.
  double at_row(double states, double kept_states, double kept_elapsed) {
    const double seconds = reader_.real(seconds_), rate = reader_.real(rate_);
    if (seconds < 0) reader_.bad(seconds_, "a time of at least 0");
    if (rate <= 0) reader_.bad(rate_, "a rate above 0");
    const double worked = (states - kept_states) / rate, passed = seconds - before_;
    before_ = seconds;
    // Less time has passed than the states took, beyond what six digits leave open: a new process, whose clock began at
    // 0.
    const bool resumed = passed < worked - 1e-4 * worked - 1e-5 * seconds - 0.01;
    return kept_elapsed + (resumed || passed <= 0 ? worked : passed);
  }

 private:
  const TsvReader& reader_;
  int seconds_, rate_;
  double before_ = 0;
};

}  // namespace

RunLogTable read_run_log(Input& input, RunLogAxis axis, const std::vector<std::string>& columns,
                         const std::vector<std::string>& others, bool growing, const std::string& instead) {
  TsvReader reader(input, growing);
  const int update_column = reader.need("update");
  const int states_column = axis == RunLogAxis::kUpdates ? -1 : reader.need("states");
  std::optional<Clock> clock;
  if (axis == RunLogAxis::kMinutes) clock.emplace(reader);
  std::vector<int> places;
  const bool may_lack = !instead.empty() && reader.find(instead) >= 0;
  for (const std::string& column : columns) places.push_back(may_lack ? reader.find(column) : reader.need(column));
  for (const std::string& column : others) places.push_back(reader.find(column));

  RunLogTable table;
  std::vector<std::vector<double>> all(places.size());
  std::vector<int64_t> updates, states;
  while (reader.next()) {
    const int64_t update = reader.integer(update_column, 0, INT64_MAX);
    // A killed run that was resumed wrote these rows again: the later ones count.
    while (!updates.empty() && updates.back() >= update) {
      updates.pop_back();
      table.x.pop_back();
      for (auto& column : all)
        if (!column.empty()) column.pop_back();
      if (!states.empty()) states.pop_back();
    }
    double x = double(update);
    if (states_column >= 0) {
      const int64_t before = states.empty() ? 0 : states.back();
      const int64_t now = reader.integer(states_column, 0, INT64_MAX);
      if (!states.empty() && now <= before)
        reader.bad(states_column, concat("more than the ", before, " of the row before"));
      x = clock ? clock->at_row(double(now), double(before), table.x.empty() ? 0 : table.x.back() * 60) / 60
                : double(now);
      states.push_back(now);
    }
    updates.push_back(update);
    table.x.push_back(x);
    for (size_t i = 0; i < places.size(); ++i)
      if (places[i] >= 0) all[i].push_back(value(reader, places[i]));
  }
  const auto middle = all.begin() + std::ptrdiff_t(columns.size());
  table.columns.assign(all.begin(), middle);
  table.others.assign(middle, all.end());
  return table;
}

}  // namespace synpo
