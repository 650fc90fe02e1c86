#include "format/run_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"

namespace synpo {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return "NA";
  const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
  char text[40];
  std::snprintf(text, sizeof text, whole ? "%.0f" : "%.6g", value);
  return text;
}

}  // namespace

// The log grows in place, so that it can be followed; whole rows are written at once.
TsvLog::TsvLog(const std::string& path, bool append, const std::vector<std::string>& columns) : path_(path) {
  if (path.empty()) return;
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (append ? O_APPEND : O_TRUNC), 0666);
  if (fd_ < 0) fail(Exit::kCantCreate, "cannot create '", path, "': ", std::strerror(errno));
  struct stat status;
  if (append && fstat(fd_, &status) == 0 && status.st_size > 0) return;
  std::string header;
  for (const std::string& column : columns) header += (header.empty() ? "" : "\t") + column;
  put(header + '\n');
}

TsvLog::~TsvLog() {
  if (fd_ >= 0) close(fd_);
}

void TsvLog::put(const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t got = ::write(fd_, text.data() + done, text.size() - done);
    if (got < 0 && errno != EINTR) fail(Exit::kIo, "cannot write '", path_, "': ", std::strerror(errno));
    if (got > 0) done += size_t(got);
  }
}

void TsvLog::write(const std::vector<double>& values) {
  if (fd_ < 0) return;
  std::string line;
  for (const double value : values) line += (line.empty() ? "" : "\t") + number(value);
  put(line + '\n');
}

RunLog::RunLog(const std::string& path, bool append)
    : log_(path, append,
           {"update", "states", "trajectories", "seconds", "states_per_s", "learning_rate", "loss", "policy", "reward",
            "env", "task", "right_move", "right_pick", "right_walk_on", "right_start", "seen_success", "seen_reward",
            "unseen_success", "unseen_reward"}) {}

void RunLog::write(const RunLogRow& row) {
  const double none = std::nan("");
  const RunLogRow::Evaluation evaluation = row.evaluation.value_or(RunLogRow::Evaluation{none, none, none, none});
  log_.write({double(row.update), double(row.states), double(row.trajectories), row.seconds, row.states_per_s,
              row.learning_rate, row.loss, row.policy, row.reward, row.env, row.task, row.right[0], row.right[1],
              row.right[2], row.right[3], evaluation.seen_success, evaluation.seen_reward, evaluation.unseen_success,
              evaluation.unseen_reward});
}

}  // namespace synpo
