// Progress of long work on stderr: a bar with rate and time left on a terminal, a plain line every so often elsewhere.
#pragma once
#include <cstdint>
#include <string>

#include "base/clock.h"

namespace synpo {

class Progress {
 public:
  // total 0: unknown. `unit` names what is counted ("updates"); `first` of them were done before.
  Progress(std::string tool, std::string unit, uint64_t total, bool quiet, uint64_t first = 0);
  ~Progress();
  void set_total(uint64_t total) { total_ = total; }
  // `note` is shown after the rate.
  void update(uint64_t done, const std::string& note = "");
  // A line of its own, "tool: text".
  void say(const std::string& text);
  // The same, "tool: warning: text", which quiet does not silence.
  void warn(const std::string& text);
  // Ends the bar's line, if one is shown.
  void finish();

 private:
  void show(uint64_t done, const std::string& note, double elapsed_s);
  void line(const std::string& text);
  std::string tool_, unit_;
  uint64_t total_, first_;
  bool quiet_, terminal_, open_ = false;
  TimePoint start_, last_;
};

// "1:02:03" or "4:05".
std::string clock_time(double seconds);
// "1.3 M", "20.0 k", "512".
std::string short_count(double count);

}  // namespace synpo
