#include "base/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "base/cli/screen.h"

namespace synpo {
namespace {

constexpr double kBarEvery_s = 0.2, kLineEvery_s = 30;
constexpr int kUsualColumns = 80;

std::string bar_of(int percent, int length) {
  const int full = percent * length / 100;
  std::string bar(size_t(length) + 3, ' ');
  bar.front() = '[';
  std::fill_n(bar.begin() + 1, full, '=');
  bar[size_t(length) + 1] = ']';
  return bar;
}

std::vector<std::string> fields_of(const std::string& note) {
  std::vector<std::string> fields;
  for (size_t begin = 0; begin < note.size();) {
    const size_t end = std::min(note.find(", ", begin), note.size());
    fields.push_back(note.substr(begin, end - begin));
    begin = end + 2;
  }
  return fields;
}

}  // namespace

std::string progress_line(const ProgressFields& fields, int columns) {
  const bool known = fields.total > 0;
  const int percent = known ? int(100 * std::min(fields.done, fields.total) / fields.total) : 0;
  std::string tool, bar, of, left, rate, note;
  const std::string so_far = known ? std::to_string(percent) + " %" : short_count(double(fields.done));
  const auto line = [&] { return tool + bar + so_far + of + left + rate + note; };
  bool room = true;
  // Once a field has had no room, none that is less important is shown.
  const auto show = [&](std::string& field, const std::string& text) {
    if (!room) return;
    const std::string before = std::exchange(field, text);
    room = columns <= 0 || line().size() <= size_t(columns);
    if (!room) field = before;
  };
  if (fields.left_s >= 0) show(left, ", " + clock_time(fields.left_s) + " left");
  show(tool, fields.tool + ": ");
  show(of, known ? " of " + short_count(double(fields.total)) + " " + fields.unit : " " + fields.unit);
  show(rate, ", " + short_count(fields.rate) + "/s");
  std::vector<std::string> notes = fields_of(fields.note);
  if (!notes.empty()) show(note, ", " + notes[0]);
  const bool has_bar = known && columns > 0;
  if (has_bar) show(bar, bar_of(percent, 5));
  for (size_t i = 1; i < notes.size(); ++i) show(note, note + ", " + notes[i]);
  room = !bar.empty();
  for (const int length : {10, 20}) show(bar, bar_of(percent, length));
  return columns > 0 ? line().substr(0, size_t(columns)) : line();
}

Progress::Progress(std::string tool, std::string unit, uint64_t total, bool quiet, uint64_t first)
    : tool_(std::move(tool)), unit_(std::move(unit)), total_(total), first_(first), quiet_(quiet),
      terminal_(isatty(2) != 0), start_(now()), last_(start_) {}

Progress::~Progress() { finish(); }

void Progress::update(uint64_t done, const std::string& note) {
  if (quiet_) return;
  done_ = done;
  note_ = note;
  const TimePoint moment = now();
  if (seconds_between(last_, moment) < (terminal_ ? kBarEvery_s : kLineEvery_s)) return;
  last_ = moment;
  show(seconds_between(start_, moment));
}

void Progress::show(double elapsed_s) {
  ProgressFields fields{tool_, unit_, done_, total_, -1, double(done_ - first_) / std::max(elapsed_s, 1e-9), note_};
  if (total_ > 0 && done_ > first_ && done_ < total_) fields.left_s = double(total_ - done_) / fields.rate;
  if (!terminal_) {
    std::fprintf(stderr, "%s\n", progress_line(fields, 0).c_str());
    return;
  }
  const int columns = screen_size(2).columns;
  // The last column stays free: a terminal is of two minds about a line that fills it.
  shown_ = progress_line(fields, std::max(1, (columns > 0 ? columns : kUsualColumns) - 1));
  // From the line's beginning, where the cursor stays, so that a terminal that was made narrower, and broke the line,
  // is cleared of all of it.
  std::fprintf(stderr, "\r\033[J%s\r", shown_.c_str());
  std::fflush(stderr);
}

void Progress::say(const std::string& text) {
  if (!quiet_) line(text);
}

void Progress::warn(const std::string& text) { line("warning: " + text); }

void Progress::line(const std::string& text) {
  std::fprintf(stderr, "%s%s: %s\n", shown_.empty() ? "" : "\r\033[J", tool_.c_str(), text.c_str());
  shown_.clear();
}

void Progress::finish() {
  if (shown_.empty()) return;
  show(seconds_between(start_, now()));
  std::fprintf(stderr, "\r\033[J%s\n", shown_.c_str());
  shown_.clear();
}

std::string clock_time(double seconds) {
  const auto whole = int64_t(std::min(seconds, 1e9) + 0.5);
  char text[32];
  if (whole >= 3600)
    std::snprintf(text, sizeof text, "%d:%02d:%02d", int(whole / 3600), int(whole / 60 % 60), int(whole % 60));
  else
    std::snprintf(text, sizeof text, "%d:%02d", int(whole / 60), int(whole % 60));
  return text;
}

std::string short_count(double count) {
  char text[32];
  if (count >= 1e6)
    std::snprintf(text, sizeof text, "%.1f M", count / 1e6);
  else if (count >= 1e4)
    std::snprintf(text, sizeof text, "%.1f k", count / 1e3);
  else
    std::snprintf(text, sizeof text, count < 10 && count != int(count) ? "%.2f" : "%.0f", count);
  return text;
}

}  // namespace synpo
