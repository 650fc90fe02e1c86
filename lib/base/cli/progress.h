// Progress of long work on stderr: a bar with rate and time left on a terminal, as wide as that is, and a plain line
// every so often elsewhere.
#pragma once
#include <cstdint>
#include <string>

#include "base/clock.h"

namespace synpo {

// What a line of progress says.
struct ProgressFields {
  std::string tool, unit;
  uint64_t done = 0, total = 0;  // total 0: unknown
  double left_s = -1;            // -1: not known
  double rate = 0;               // of `unit` in a second
  std::string note;              // fields with ", " between, the most important first
};
// In at most `columns` columns, with a bar. Where they are too few, fields are left out: first the bar becomes shorter,
// then the note loses its fields from its end, then the bar goes, the rate, the total, the tool, the time left. 0: all,
// without a bar.
std::string progress_line(const ProgressFields& fields, int columns);

class Progress {
 public:
  // total 0: unknown. `unit` names what is counted ("updates"); `first` of them were done before.
  Progress(std::string tool, std::string unit, uint64_t total, bool quiet, uint64_t first = 0);
  ~Progress();
  void set_total(uint64_t total) { total_ = total; }
  // `note` is shown after the rate: fields with ", " between, the most important first.
  void update(uint64_t done, const std::string& note = "");
  // A line of its own, "tool: text".
  void say(const std::string& text);
  // The same, "tool: warning: text", which quiet does not silence.
  void warn(const std::string& text);
  // Ends the bar's line, if one is shown, with what the last update said.
  void finish();

 private:
  void show(double elapsed_s);
  void line(const std::string& text);
  std::string tool_, unit_;
  uint64_t total_, first_, done_ = 0;
  bool quiet_, terminal_;
  std::string note_, shown_;  // the last update's; the bar's line, if one is shown
  TimePoint start_, last_;
};

// "1:02:03" or "4:05".
std::string clock_time(double seconds);
// "1.3 M", "20.0 k", "512".
std::string short_count(double count);

}  // namespace synpo
