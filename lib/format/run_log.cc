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
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

// The log grows in place, so that it can be followed; whole rows are written at once.
RunLog::RunLog(const std::string& path, bool append) : path_(path) {
  if (path.empty()) return;
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (append ? O_APPEND : O_TRUNC), 0666);
  if (fd_ < 0) fail(Exit::kCantCreate, "cannot create '", path, "': ", std::strerror(errno));
  struct stat status;
  if (append && fstat(fd_, &status) == 0 && status.st_size > 0) return;
  put("update\tstates\ttrajectories\tseconds\tstates_per_s\tlearning_rate\tloss\tpolicy\treward\tenv\ttask\t"
      "right_move\tright_pick\tright_walk_on\tright_start\tseen_success\tseen_reward\tunseen_success\tunseen_reward\n");
}

RunLog::~RunLog() {
  if (fd_ >= 0) close(fd_);
}

void RunLog::put(const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t got = ::write(fd_, text.data() + done, text.size() - done);
    if (got < 0 && errno != EINTR) fail(Exit::kIo, "cannot write '", path_, "': ", std::strerror(errno));
    if (got > 0) done += size_t(got);
  }
}

void RunLog::write(const RunLogRow& row) {
  if (fd_ < 0) return;
  std::string line = std::to_string(row.update) + '\t' + std::to_string(row.states) + '\t' + std::to_string(row.trajectories);
  for (const double value : {row.seconds, row.states_per_s, row.learning_rate, row.loss, row.policy, row.reward, row.env, row.task,
                             row.right[0], row.right[1], row.right[2], row.right[3]})
    line += '\t' + number(value);
  const double none = std::nan("");
  const RunLogRow::Evaluation evaluation = row.evaluation.value_or(RunLogRow::Evaluation{none, none, none, none});
  for (const double value : {evaluation.seen_success, evaluation.seen_reward, evaluation.unseen_success, evaluation.unseen_reward})
    line += '\t' + number(value);
  put(line + '\n');
}

}  // namespace synpo
