#include "base/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace synpo {
namespace {
constexpr double kBarEvery_s = 0.2, kLineEvery_s = 30;
}

Progress::Progress(std::string tool, std::string unit, uint64_t total, bool quiet, uint64_t first)
    : tool_(std::move(tool)), unit_(std::move(unit)), total_(total), first_(first), quiet_(quiet),
      terminal_(isatty(2) != 0), start_(now()), last_(start_) {}

Progress::~Progress() { finish(); }

void Progress::update(uint64_t done, const std::string& note) {
  if (quiet_) return;
  const TimePoint moment = now();
  if (seconds_between(last_, moment) < (terminal_ ? kBarEvery_s : kLineEvery_s)) return;
  last_ = moment;
  show(done, note, seconds_between(start_, moment));
}

void Progress::show(uint64_t done, const std::string& note, double elapsed_s) {
  const double rate = double(done - first_) / std::max(elapsed_s, 1e-9);
  std::string line = tool_ + ": ";
  if (total_ > 0) {
    const int percent = int(100 * std::min(done, total_) / total_);
    if (terminal_) line.append(1, '[').append(percent / 5, '=').append(20 - percent / 5, ' ').append("] ");
    line += std::to_string(percent) + " % of " + short_count(double(total_)) + " " + unit_;
    if (done > first_ && done < total_) line += ", " + clock_time((total_ - done) / rate) + " left";
  } else {
    line += short_count(double(done)) + " " + unit_;
  }
  line += ", " + short_count(rate) + "/s";
  if (!note.empty()) line += ", " + note;
  if (terminal_) {
    std::fprintf(stderr, "\r%s\033[K", line.c_str());
    std::fflush(stderr);
    open_ = true;
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
}

void Progress::say(const std::string& text) {
  if (!quiet_) line(text);
}

void Progress::warn(const std::string& text) { line("warning: " + text); }

void Progress::line(const std::string& text) {
  std::fprintf(stderr, "%s%s: %s\n", open_ ? "\r\033[K" : "", tool_.c_str(), text.c_str());
  open_ = false;
}

void Progress::finish() {
  if (open_) std::fputc('\n', stderr);
  open_ = false;
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
