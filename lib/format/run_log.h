// Run logs: TSV, a row a report, flushed, and read back (synpo-log(5)).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files/io.h"

namespace synpo {

struct RunLogRow {
  int64_t update = 0, states = 0, trajectories = 0;
  double seconds = 0, states_per_s = 0, learning_rate = 0;
  double loss = 0, policy = 0, reward = 0, env = 0, task = 0;  // means since the row before
  double right[4] = {};  // accuracy on moves, picks, walking on, starts; NaN where there were none
  // Success and mean return on sampled pairs; only in rows after an evaluation.
  struct Evaluation {
    double seen_success, seen_reward, unseen_success, unseen_reward;
  };
  std::optional<Evaluation> evaluation;
};

// A table that grows a row at a time, in place, so that it can be followed. Nothing is written before the first row is
// due; a file made for it is gone if none was.
class TsvLog {
 public:
  // A log that is there already is written anew, or continued where `append`: then it is looked at first, and a last
  // row that was cut off gives way to the first new one. An empty path writes nowhere. Throws kCantCreate for what
  // cannot be written, and where another process writes it; kData, with the line, for a table to continue that is
  // another one; kUsage for -, and for a file that the command uses otherwise (base/files/file_uses.h).
  TsvLog(const std::string& path, bool append, const std::vector<std::string>& columns);
  ~TsvLog();
  TsvLog(const TsvLog&) = delete;
  TsvLog& operator=(const TsvLog&) = delete;

  // A value for each column; NaN is NA. Nothing where failed().
  void write(const std::vector<double>& values);
  // A row could not be written (kIo), and none will be from there on. The work that the log is of is worth more than
  // the log: it goes on, and check() throws at its end.
  bool failed() const;
  void check() const;

 private:
  struct File;
  std::unique_ptr<File> file_;  // null where it writes nowhere
};

// The log of imitation learning: its columns, and a row of them.
const std::vector<std::string>& run_log_columns();
std::vector<double> run_log_values(const RunLogRow& row);

// The axis along which a log's rows stand. Minutes are of training up to the row: those of resumed runs are added
// up, and updates that were done again count once.
enum class RunLogAxis { kUpdates, kStates, kMinutes };

struct RunLogTable {
  std::vector<double> x;                     // rises from row to row
  std::vector<std::vector<double>> columns;  // as asked for, x.size() each; NaN for NA
  std::vector<std::vector<double>> others;  // the same of the columns that need not be there; empty for one that is not
};

// Needs the column update, those of the axis, and `columns`, but not `others`; where there is a column `instead`, not
// `columns` either. Throws kData, with the place, for anything that is no such log. Of one that is `growing`, a row
// that is still being written is passed over.
RunLogTable read_run_log(Input& input, RunLogAxis axis, const std::vector<std::string>& columns,
                         const std::vector<std::string>& others = {}, bool growing = false,
                         const std::string& instead = "");

}  // namespace synpo
