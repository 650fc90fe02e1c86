#include "format/matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "format/tsv.h"

namespace synpo {
namespace {

constexpr size_t kMaxRows = 1000000;
constexpr size_t kMaxExtraFields = 16000000;
// Small enough that sums over kMaxRows rows stay within 64 bits.
constexpr int64_t kMaxCount = 1000000000000;
constexpr double kMaxReward = 1e15;
constexpr int64_t kMaxWhole = std::numeric_limits<int64_t>::max();

// In the order in which they are written.
enum Column {
  kRun,
  kWorld,
  kWindow,
  kMethod,
  kSeed,
  kUpdates,
  kEvalSeed,
  kFirst,
  kEnv,
  kTask,
  kSeen,
  kEpisodes,
  kSuccesses,
  kWrong,
  kTimeouts,
  kReward,
  kLength
};
const char* const kColumns[] = {"run",       "world",         "window",   "method", "seed",  "updates",
                                "eval_seed", "first_episode", "env",      "task",   "seen",  "episodes",
                                "successes", "wrong",         "timeouts", "reward", "length"};

// A reader and the positions of the columns that this build knows; -1 where the file has no such column.
class RowReader {
 public:
  explicit RowReader(Input& input) : reader_(input) {
    for (const char* name : {"env", "task", "episodes", "successes"}) reader_.need(name);
    for (size_t i = 0; i < reader_.columns().size(); ++i) {
      const std::string& name = reader_.columns()[i];
      if (name != "part" && std::find(std::begin(kColumns), std::end(kColumns), name) == std::end(kColumns))
        extra_.push_back(int(i));
    }
    for (size_t i = 0; i < std::size(kColumns); ++i) at_[i] = reader_.find(kColumns[i]);
    part_ = reader_.find("part");
  }

  bool next(MatrixRow& row) {
    if (!reader_.next()) return false;
    row = MatrixRow();
    text(kRun, row.run);
    text(kWorld, row.world);
    whole(kWindow, row.window, 0, kMaxCount);
    text(kMethod, row.method);
    seed(kSeed, row.seed);
    whole(kUpdates, row.updates, 0, kMaxWhole);
    seed(kEvalSeed, row.eval_seed);
    whole(kFirst, row.first_episode, 0, kMaxCount);
    text(kEnv, row.env);
    text(kTask, row.task);
    if (row.env.empty()) reader_.bad(at_[kEnv], "the name of an environment");
    if (row.task.empty()) reader_.bad(at_[kTask], "the name of a task");
    if (at_[kSeen] >= 0) row.seen = reader_.integer(at_[kSeen], 0, 1) == 1;
    whole(kEpisodes, row.episodes, 1, kMaxCount);
    whole(kSuccesses, row.successes, 0, kMaxCount);
    whole(kWrong, row.wrong, 0, kMaxCount);
    whole(kTimeouts, row.timeouts, 0, kMaxCount);
    if (row.successes > row.episodes)
      reader_.bad(at_[kSuccesses], concat("at most ", row.episodes, ", the row's episodes"));
    if (row.successes + row.wrong + row.timeouts > row.episodes)
      fail_row(concat("found ", row.successes, " successes + ", row.wrong, " wrong + ", row.timeouts,
                      " timeouts, expected at most ", row.episodes, ", the row's episodes"));
    if (at_[kReward] >= 0) {
      row.reward = reader_.real(at_[kReward]);
      if (std::abs(row.reward) > kMaxReward) reader_.bad(at_[kReward], "a sum between -1e15 and 1e15");
    }
    whole(kLength, row.length, 0, kMaxCount);
    if (part_ >= 0) {
      row.part = reader_.field(part_);
      if (!row.part.empty() && row.part != "P" && row.part != "Q" && row.part != "rest")
        reader_.bad(part_, "P, Q, rest or nothing");
    }
    for (int column : extra_) row.extra.push_back(reader_.field(column));
    return true;
  }

  bool has_part() const { return part_ >= 0; }
  uint64_t line() const { return reader_.line(); }
  std::vector<std::string> extra_columns() const {
    std::vector<std::string> names;
    for (int column : extra_) names.push_back(reader_.columns()[column]);
    return names;
  }
  [[noreturn]] void fail_row(const std::string& message) const { reader_.bad_row(message); }

 private:
  void text(Column known, std::string& value) const {
    if (at_[known] >= 0) value = reader_.field(at_[known]);
  }
  void whole(Column known, int64_t& value, int64_t low, int64_t high) const {
    if (at_[known] >= 0) value = reader_.integer(at_[known], low, high);
  }
  void seed(Column known, uint64_t& value) const {
    if (at_[known] >= 0) value = uint64_t(reader_.integer(at_[known], 0, kMaxWhole));
  }

  TsvReader reader_;
  int at_[std::size(kColumns)];
  int part_;
  std::vector<int> extra_;
};

}  // namespace

std::string run_key(const MatrixRow& row) {
  if (!row.run.empty()) return row.run;
  return concat('\t', row.world, '\t', row.window, '\t', row.method, '\t', row.seed, '\t', row.updates);
}

Matrix read_matrix(Input& input) {
  RowReader reader(input);
  Matrix matrix;
  matrix.has_part = reader.has_part();
  matrix.extra_columns = reader.extra_columns();
  std::unordered_map<std::string, uint64_t> line_of;
  MatrixRow row;
  while (reader.next(row)) {
    if (matrix.rows.size() == kMaxRows) reader.fail_row(concat("more than ", kMaxRows, " rows"));
    if (matrix.extra_columns.size() * matrix.rows.size() > kMaxExtraFields)
      reader.fail_row(concat("more than ", kMaxExtraFields, " fields in columns that are none of this format's"));
    std::string key = concat(run_key(row), '\t', row.eval_seed, '\t', row.env, '\t', row.task, '\t', row.first_episode);
    const auto [it, fresh] = line_of.try_emplace(std::move(key), reader.line());
    if (!fresh)
      reader.fail_row(concat("pair ", quoted(row.env), ", ", quoted(row.task), " from episode ", row.first_episode,
                             " on stands in line ", it->second, " already (same run and eval_seed)"));
    matrix.rows.push_back(std::move(row));
  }
  if (matrix.rows.empty())
    fail(Exit::kData, input.name(), ": line 1: found a header and no row, expected at least one pair");
  return matrix;
}

void write_matrix(Output& output, const Matrix& matrix) {
  TsvWriter writer(output);
  for (const char* name : kColumns) writer.text(name);
  if (matrix.has_part) writer.text("part");
  for (const std::string& name : matrix.extra_columns) writer.text(name);
  writer.end_row();
  for (const MatrixRow& row : matrix.rows) {
    writer.text(row.run).text(row.world).whole(row.window).text(row.method).whole(row.seed).whole(row.updates);
    writer.whole(row.eval_seed).whole(row.first_episode).text(row.env).text(row.task).whole(int64_t{row.seen});
    writer.whole(row.episodes)
        .whole(row.successes)
        .whole(row.wrong)
        .whole(row.timeouts)
        .real(row.reward)
        .whole(row.length);
    if (matrix.has_part) writer.text(row.part);
    for (const std::string& field : row.extra) writer.text(field);
    writer.end_row();
  }
}

}  // namespace synpo
