#include "stats/matrix/filter.h"

#include <algorithm>
#include <unordered_map>

#include "base/error.h"
#include "base/text.h"
#include "format/tsv.h"
#include "stats/matrix/runs.h"

namespace synpo {
namespace {

template <class Value>
bool holds(const std::set<Value>& set, const Value& value) {
  return set.empty() || set.contains(value);
}

std::string shown(const std::string& name) { return quoted(name); }
std::string shown(uint64_t seed) { return std::to_string(seed); }
std::string shown(double temperature) { return shortest(temperature); }
std::string shown(const std::pair<std::string, std::string>& pair) {
  return quoted(pair.first) + ", " + quoted(pair.second);
}

// -1, which none is, where the row does not say it.
double temperature_of(const MatrixRow& row) { return row.temperature.value_or(-1); }

template <class Value>
std::string guess(const Value&, const std::set<Value>&) {
  return "";
}
std::string guess(const std::string& name, const std::set<std::string>& names) {
  return did_you_mean(name, {names.begin(), names.end()});
}

template <class Value, class Of>
void check_names(const std::set<Value>& named, const Matrix& matrix, const char* what, Of of) {
  if (named.empty()) return;
  std::set<Value> there;
  for (const MatrixRow& row : matrix.rows) there.insert(of(row));
  for (const Value& value : named)
    if (!there.contains(value)) fail(Exit::kData, "the matrix has no ", what, ' ', shown(value), guess(value, there));
}

}  // namespace

bool RowFilter::fits(const MatrixRow& row) const {
  return holds(envs, row.env) && holds(tasks, row.task) && holds(methods, row.method) && holds(parts, row.part) &&
         holds(seeds, row.seed) && holds(pairs, {row.env, row.task}) && holds(standings, row.standing()) &&
         holds(temperatures, temperature_of(row));
}

Matrix filter_rows(const Matrix& matrix, const RowFilter& filter) {
  check_names(filter.envs, matrix, "environment", [](const MatrixRow& row) { return row.env; });
  check_names(filter.tasks, matrix, "task", [](const MatrixRow& row) { return row.task; });
  check_names(filter.methods, matrix, "method", [](const MatrixRow& row) { return row.method; });
  check_names(filter.parts, matrix, "part", [](const MatrixRow& row) { return row.part; });
  check_names(filter.seeds, matrix, "seed", [](const MatrixRow& row) { return row.seed; });
  check_names(filter.pairs, matrix, "pair", [](const MatrixRow& row) { return std::pair(row.env, row.task); });
  check_names(filter.temperatures, matrix, "temperature", temperature_of);
  Matrix left;
  left.has_part = matrix.has_part;
  left.extra_columns = matrix.extra_columns;
  for (const MatrixRow& row : matrix.rows)
    if (filter.fits(row) != filter.inverted) left.rows.push_back(row);
  if (left.rows.empty()) fail(Exit::kData, "no row is left of ", matrix.rows.size(), ", and a matrix has at least one");
  return left;
}

bool is_wide_measure(const std::string& name) {
  const auto& kinds = measure_kinds();
  return name == "episodes" || name == "successes" || name == "seen" ||
         std::any_of(kinds.begin(), kinds.end(), [&](const MeasureKind& kind) { return name == kind.name; });
}

void write_wide(Output& output, const Matrix& matrix, const std::vector<std::string>& envs,
                const std::vector<std::string>& tasks, const std::string& measure) {
  struct Cell {
    Tally tally;
    bool seen;
  };
  std::unordered_map<std::string, Cell> cells;
  for (const MatrixRow& row : matrix.rows)
    cells.try_emplace(row.env + '\t' + row.task, Cell{{}, row.seen}).first->second.tally.add(row);
  TsvWriter writer(output);
  writer.text("task");
  for (const std::string& env : envs) writer.text(env);
  writer.end_row();
  for (const std::string& task : tasks) {
    writer.text(task);
    for (const std::string& env : envs) {
      const auto cell = cells.find(env + '\t' + task);
      if (cell == cells.end())
        writer.text("NA");
      else if (measure == "seen")
        writer.whole(int64_t{cell->second.seen});
      else if (measure == "episodes" || measure == "successes")
        writer.whole(measure == "episodes" ? cell->second.tally.episodes : cell->second.tally.successes);
      else
        writer.real(find_measure(measure).value(cell->second.tally));
    }
    writer.end_row();
  }
}

}  // namespace synpo
