// Run logs, as curves read them along each axis, and as a resumed run continues them: its row is the last one then, and
// nothing that was a whole row before is lost.
#include "format/run_log.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz.h"

using namespace synpo;

namespace {

// A log that is continued has a name.
class LogFile {
 public:
  LogFile() {
    const int fd = mkstemp(path_.data());
    fuzz::require(fd >= 0, "a log can be made");
    close(fd);
  }
  ~LogFile() { unlink(path_.c_str()); }
  const std::string& path() const { return path_; }
  void write(std::string_view bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
  std::string read() const {
    std::ifstream file(path_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "fuzz_log_XXXXXX").string();
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  for (const RunLogAxis axis : {RunLogAxis::kUpdates, RunLogAxis::kStates, RunLogAxis::kMinutes})
    fuzz::accepts([&] {
      fuzz::Bytes bytes(fuzz::text(data, size));
      const RunLogTable table = read_run_log(bytes.input(), axis, {"seen_success", "loss"});
      for (size_t i = 1; i < table.x.size(); ++i) fuzz::require(table.x[i] > table.x[i - 1], "the axis rises");
      for (const auto& column : table.columns) fuzz::require(column.size() == table.x.size(), "columns are whole");
    });
  static const LogFile log;
  const std::string before(fuzz::text(data, size));
  log.write(before);
  const bool continued = fuzz::accepts([&] {
    TsvLog rows(log.path(), true, {"update", "loss"});
    rows.write({1, 0.5});
    rows.check();
  });
  const std::string after = log.read(), row = "1\t0.5\n";
  if (continued) {
    fuzz::require(after.ends_with(row), "the new row is the last one");
    // All but a last row that was cut off.
    const size_t whole = before.rfind('\n') + 1;
    fuzz::require(whole == 0 ? after == "update\tloss\n" + row : after == before.substr(0, whole) + row,
                  "whole rows stay");
  } else {
    fuzz::require(after == before, "a table that is refused stays as it is");
  }
  return 0;
}
