// Run logs: TSV, a row a report, flushed, and read back (synpo-log(5)).
#pragma once
#include <cstdint>
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
  // Success and mean return on sampled pairs; only in rows behind an evaluation.
  struct Evaluation {
    double seen_success, seen_reward, unseen_success, unseen_reward;
  };
  std::optional<Evaluation> evaluation;
};

// A table that grows a row at a time.
class TsvLog {
 public:
  // Writes the header; a log that is there already is written anew, or continued where `append`. An empty path writes
  // nowhere.
  TsvLog(const std::string& path, bool append, const std::vector<std::string>& columns);
  ~TsvLog();
  TsvLog(const TsvLog&) = delete;
  TsvLog& operator=(const TsvLog&) = delete;
  // A value for each column; NaN is NA.
  void write(const std::vector<double>& values);

 private:
  int fd_ = -1;
  std::string path_;
  void put(const std::string& text);
};

// The log of imitation learning.
class RunLog {
 public:
  RunLog(const std::string& path, bool append);
  void write(const RunLogRow& row);

 private:
  TsvLog log_;
};

// What a log's rows are put against. Minutes are of training up to the row: those of resumed runs are added up, and
// updates that were done again count once.
enum class RunLogAxis { kUpdates, kStates, kMinutes };

struct RunLogTable {
  std::vector<double> x;                     // rises from row to row
  std::vector<std::vector<double>> columns;  // as asked for, x.size() each; NaN for NA
};

// Needs the column update, those of the axis, and `columns`. Throws kData, with the place, for anything that is no such
// log.
RunLogTable read_run_log(Input& input, RunLogAxis axis, const std::vector<std::string>& columns);

}  // namespace synpo
