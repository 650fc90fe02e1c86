#include "format/matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/text.h"
#include "format/tsv.h"

namespace synpo {
namespace {

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
  kLength,
  kPart,
  kTemperature,
  kNew,
  kEnvHash
};
const char* const kColumns[] = {"run",           "world",  "window", "method", "seed",        "updates",   "eval_seed",
                                "first_episode", "env",    "task",   "seen",   "episodes",    "successes", "wrong",
                                "timeouts",      "reward", "length", "part",   "temperature", "new",       "env_hash"};

// A reader and the positions of the columns that this build knows; -1 where the file has no such column.
class RowReader {
 public:
  RowReader(Input& input, bool or_pairs) : reader_(input) {
    const auto has = [&](const char* name) { return reader_.find(name) >= 0; };
    const bool pairs = or_pairs && has("seen") && !has("episodes") && !has("successes");
    for (const char* name : {"env", "task"}) reader_.need(name);
    if (!pairs)
      for (const char* name : {"episodes", "successes"}) reader_.need(name);
    for (size_t i = 0; i < reader_.columns().size(); ++i) {
      const std::string& name = reader_.columns()[i];
      if (std::find(std::begin(kColumns), std::end(kColumns), name) == std::end(kColumns)) extra_.push_back(int(i));
    }
    for (size_t i = 0; i < std::size(kColumns); ++i) at_[i] = reader_.find(kColumns[i]);
  }

  bool next(MatrixRow& row) {
    if (!reader_.next()) return false;
    row = MatrixRow();
    text(kRun, row.run);
    text(kWorld, row.world);
    whole(kWindow, row.window, 0, kMatrixCount);
    if (says(kMethod)) row.method = reader_.name(at_[kMethod], "the name of a method");
    seed(kSeed, row.seed);
    whole(kUpdates, row.updates, 0, kMaxWhole);
    seed(kEvalSeed, row.eval_seed);
    whole(kFirst, row.first_episode, 0, kMatrixCount);
    row.env = reader_.name(at_[kEnv], "the name of an environment");
    row.task = reader_.name(at_[kTask], "the name of a task");
    if (at_[kSeen] >= 0) row.seen = reader_.integer(at_[kSeen], 0, 1) == 1;
    if (at_[kNew] >= 0) row.is_new = reader_.integer(at_[kNew], 0, 1) == 1;
    if (row.seen && row.is_new) reader_.bad(at_[kNew], "0 of a pair that is seen");
    whole(kEpisodes, row.episodes, 1, kMatrixCount);
    whole(kSuccesses, row.successes, 0, kMatrixCount);
    whole(kWrong, row.wrong, 0, kMatrixCount);
    whole(kTimeouts, row.timeouts, 0, kMatrixCount);
    if (row.successes > row.episodes)
      reader_.bad(at_[kSuccesses], concat("at most ", row.episodes, ", the row's episodes"));
    if (row.successes + row.wrong + row.timeouts > row.episodes)
      fail_row(concat("found ", row.successes, " successes + ", row.wrong, " wrong + ", row.timeouts,
                      " timeouts, expected at most ", row.episodes, ", the row's episodes"));
    if (!says(kReward))
      row.reward = std::nan("");
    else if (row.reward = reader_.real(at_[kReward]); std::abs(row.reward) > kMatrixReward)
      reader_.bad(at_[kReward], "a sum between -1e15 and 1e15");
    whole(kLength, row.length, 0, kMatrixCount);
    text(kPart, row.part);
    if (!row.part.empty() && row.part != "P" && row.part != "Q" && row.part != "rest")
      reader_.bad(at_[kPart], "P, Q, rest or nothing");
    if (says(kTemperature)) row.temperature = reader_.real(at_[kTemperature]) + 0.0;  // -0 is 0: one run
    if (row.temperature.value_or(0) < 0) reader_.bad(at_[kTemperature], "a number, at least 0");
    text(kEnvHash, row.env_hash);
    for (int column : extra_) row.extra.push_back(reader_.field(column));
    return true;
  }

  bool has_part() const { return at_[kPart] >= 0; }
  uint64_t line() const { return reader_.line(); }
  std::vector<std::string> extra_columns() const {
    std::vector<std::string> names;
    for (int column : extra_) names.push_back(reader_.columns()[column]);
    return names;
  }
  [[noreturn]] void fail_row(const std::string& message) const { reader_.bad_row(message); }

 private:
  bool says(Column known) const { return at_[known] >= 0 && !reader_.field(at_[known]).empty(); }
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
  std::vector<int> extra_;
};

}  // namespace

const char* name_of(Standing standing) {
  return standing == Standing::kSeen ? "seen" : standing == Standing::kUnseen ? "unseen" : "new";
}

std::string training_key(const MatrixRow& row) {
  if (!row.run.empty()) return row.run;
  return concat('\t', row.world, '\t', row.window, '\t', row.method, '\t', row.seed, '\t', row.updates);
}

std::string run_key(const MatrixRow& row) {
  std::string key = training_key(row);
  if (row.temperature) key.append(1, '\t').append(shortest(*row.temperature));
  return key;
}

Matrix read_matrix(Input& input, bool or_pairs) {
  RowReader reader(input, or_pairs);
  Matrix matrix;
  matrix.has_part = reader.has_part();
  matrix.extra_columns = reader.extra_columns();
  std::unordered_map<std::string, uint64_t> line_of;
  MatrixRow row;
  while (reader.next(row)) {
    if (matrix.rows.size() == kMatrixRows) reader.fail_row(concat("more than ", kMatrixRows, " rows"));
    if (matrix.extra_columns.size() * matrix.rows.size() > kMatrixExtraFields)
      reader.fail_row(concat("more than ", kMatrixExtraFields, " fields in columns that are none of this format's"));
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
  const auto any = [&](auto says) { return std::any_of(matrix.rows.begin(), matrix.rows.end(), says); };
  const bool rewards = any([](const MatrixRow& row) { return !std::isnan(row.reward); });
  const bool temperatures = any([](const MatrixRow& row) { return row.temperature.has_value(); });
  const bool news = any([](const MatrixRow& row) { return row.is_new; });
  const bool hashes = any([](const MatrixRow& row) { return !row.env_hash.empty(); });
  if (matrix.rows.size() > kMatrixRows)
    fail(Exit::kData, "a matrix of ", matrix.rows.size(), " rows, at most ", kMatrixRows, " can be read");
  if (matrix.extra_columns.size() > kTsvColumns - std::size(kColumns))
    fail(Exit::kData, "a matrix with ", matrix.extra_columns.size(),
         " columns that are none of this format's, at most ", kTsvColumns - std::size(kColumns), " can be read");
  if (matrix.extra_columns.size() * matrix.rows.size() > kMatrixExtraFields)
    fail(Exit::kData, "a matrix with more than ", kMatrixExtraFields,
         " fields in columns that are not of this format cannot be read");
  TsvWriter writer(output);
  for (int column = 0; column <= kEnvHash; ++column)
    if (column == kReward        ? rewards
        : column == kPart        ? matrix.has_part
        : column == kTemperature ? temperatures
        : column == kNew         ? news
        : column == kEnvHash     ? hashes
                                 : true)
      writer.text(kColumns[column]);
  for (const std::string& name : matrix.extra_columns) writer.text(name);
  writer.end_row();
  for (const MatrixRow& row : matrix.rows) {
    writer.text(row.run).text(row.world).whole(row.window).text(row.method).whole(row.seed).whole(row.updates);
    writer.whole(row.eval_seed).whole(row.first_episode).text(row.env).text(row.task).whole(int64_t{row.seen});
    writer.whole(row.episodes).whole(row.successes).whole(row.wrong).whole(row.timeouts);
    if (rewards) writer.text(std::isnan(row.reward) ? "" : shortest(row.reward));
    writer.whole(row.length);
    if (matrix.has_part) writer.text(row.part);
    if (temperatures) writer.text(row.temperature ? shortest(*row.temperature) : "");
    if (news) writer.whole(int64_t{row.is_new});
    if (hashes) writer.text(row.env_hash);
    for (const std::string& field : row.extra) writer.text(field);
    writer.end_row();
  }
}

}  // namespace synpo
