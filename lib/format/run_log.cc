#include "format/run_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/files/descriptor.h"
#include "base/files/destination.h"
#include "base/files/file_uses.h"
#include "base/leftovers.h"
#include "base/text.h"

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

struct TsvLog::File {
  File(const std::string& where, const std::string& columns, const Destination& destination)
      : path(where), header(columns), use(where, destination.identity()) {}

  std::string path, header;
  OutputUse use;
  Descriptor opened = {};
  std::optional<Leftover> made = {};  // as long as nothing is in it
  std::string made_path = {};
  bool in_place = false, begun = false, left = false;  // left: a stop signal came while a pipe was full
  uint64_t end = 0;                                    // of the rows that are continued
  std::optional<Error> failure = {};

  ~File() {
    if (made) unlink(made_path.c_str());
  }

  void open_place(const Destination& destination) {
    in_place = destination.kind != Destination::Kind::kFile;
    if (destination.kind == Destination::Kind::kDescriptor)
      opened = Descriptor(fcntl(destination.descriptor, F_DUPFD_CLOEXEC, 0));
    else if (in_place)
      opened = open_in_place(path);
    else
      open_file(destination);
    if (!opened) destination.cannot_create(std::strerror(errno));
    if (!in_place && flock(opened.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      destination.cannot_create("another process writes this log");
  }

  void open_file(const Destination& destination) {
    const auto open_with = [&](int flags) {
      return Descriptor(open(destination.target.c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC | flags, 0666));
    };
    if (!destination.exists) {
      made_path = destination.target;
      made.emplace(made_path, Leftover::Kind::kFile);
      opened = open_with(O_CREAT | O_EXCL);
      if (!opened) made.reset();
    }
    if (destination.exists || (!opened && errno == EEXIST)) opened = open_with(0);
  }

  // Finds the end of the last whole row.
  void look(size_t fields) {
    Input rows(opened.get(), path);
    std::string line;
    while (rows.line(line)) {
      const bool whole = rows.offset() - end > line.size();
      if (whole && line.ends_with('\r'))
        rows.bad_line("ends in CR LF, expected LF alone: take the CRs out first, for instance with tr -d '\\r'");
      if (rows.line_number() == 1 && line != header && (whole || !header.starts_with(line)))
        rows.bad_line(concat("found ", quoted(line), ", expected the columns ", quoted(header), ": another table"));
      if (!whole) return;
      const auto found = size_t(std::count(line.begin(), line.end(), '\t')) + 1;
      if (found != fields)
        rows.bad_line(concat("found ", counted(int64_t(found), "field"), ", expected ", fields,
                             " as in the header: a row that was cut off?"));
      end = rows.offset();
    }
  }

  void fail_with_errno() { failure.emplace(Exit::kIo, concat("cannot write '", path, "': ", std::strerror(errno))); }

  // Before the first row.
  void begin() {
    begun = true;
    made.reset();
    if (!in_place && ftruncate(opened.get(), off_t(end)) != 0)
      fail_with_errno();
    else if (end == 0)
      put(header + '\n');
  }

  // Whole rows are written at once; of one that does not fit the file keeps nothing.
  void put(const std::string& text) {
    const off_t before = lseek(opened.get(), 0, SEEK_END);
    if (write_until_stop(opened.get(), text)) return;
    left = errno == EINTR;
    if (!left) fail_with_errno();
    if (!in_place && ftruncate(opened.get(), before) != 0) return;
  }
};

TsvLog::TsvLog(const std::string& path, bool append, const std::vector<std::string>& columns) {
  if (path.empty()) return;
  if (path == "-") fail(Exit::kUsage, "a log cannot go to standard output: expected a file, found '-'");
  std::string header;
  for (const std::string& column : columns) header += (header.empty() ? "" : "\t") + column;
  const Destination destination = Destination::find(path);
  file_ = std::make_unique<File>(path, header, destination);
  file_->open_place(destination);
  if (append && !file_->in_place) file_->look(columns.size());
}

TsvLog::~TsvLog() = default;

void TsvLog::write(const std::vector<double>& values) {
  if (!file_ || failed() || file_->left) return;
  if (!file_->begun) file_->begin();
  std::string line;
  for (const double value : values) line.append(line.empty() ? "" : "\t").append(number(value));
  if (!failed()) file_->put(line + '\n');
}

bool TsvLog::failed() const { return file_ && file_->failure; }

void TsvLog::check() const {
  if (failed()) throw Error(*file_->failure);
}

const std::vector<std::string>& run_log_columns() {
  static const std::vector<std::string> columns = {
      "update",      "states",       "trajectories", "seconds",        "states_per_s", "learning_rate", "loss",
      "policy",      "reward",       "env",          "task",           "right_move",   "right_pick",    "right_walk_on",
      "right_start", "seen_success", "seen_reward",  "unseen_success", "unseen_reward"};
  return columns;
}

std::vector<double> run_log_values(const RunLogRow& row) {
  const double none = std::nan("");
  const RunLogRow::Evaluation evaluation = row.evaluation.value_or(RunLogRow::Evaluation{none, none, none, none});
  return {double(row.update),
          double(row.states),
          double(row.trajectories),
          row.seconds,
          row.states_per_s,
          row.learning_rate,
          row.loss,
          row.policy,
          row.reward,
          row.env,
          row.task,
          row.right[0],
          row.right[1],
          row.right[2],
          row.right[3],
          evaluation.seen_success,
          evaluation.seen_reward,
          evaluation.unseen_success,
          evaluation.unseen_reward};
}

}  // namespace synpo
