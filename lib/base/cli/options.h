// Command lines: a table of options over getopt_long, --help and --version for every tool, one place that turns errors
// into a message and an exit code.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace synpo {

extern const char kVersion[];

class Options {
 public:
  // `synopsis` is what follows the tool's name; `purpose` one or two lines for --help.
  Options(std::string tool, std::string synopsis, std::string purpose);

  // `letter` may be 0. `help` is one line; the default is read from `value` and shown. A value outside the range given,
  // or that is no number, is a usage error (64).
  Options& flag(char letter, const char* name, const char* help, bool& value);
  Options& integer(char letter, const char* name, const char* arg, const char* help, int64_t& value, int64_t low,
                   int64_t high);
  Options& real(char letter, const char* name, const char* arg, const char* help, double& value, double low,
                double high);
  Options& text(char letter, const char* name, const char* arg, const char* help, std::string& value);
  // One of these words; any other is a usage error that names them.
  Options& choice(char letter, const char* name, const char* arg, const char* help, std::string& value,
                  std::vector<std::string> words);
  // Calls `set` with the argument; std::invalid_argument thrown by it is a usage error that names the option.
  Options& call(char letter, const char* name, const char* arg, const char* help,
                std::function<void(const std::string&)> set);
  // A heading in --help above the options that follow.
  Options& section(const char* title);

  // Returns the operands. Between `least` and `most` are accepted. Prints and exits 0 on --help and --version.
  std::vector<std::string> parse(int argc, char** argv, int least = 0, int most = 0);
  // True when the option was given on the command line.
  bool given(const char* name) const;

 private:
  struct Entry {
    char letter;
    std::string name, arg, help, shown_default;
    std::function<void(const std::string&)> set;
    bool heading = false, given = false;
  };
  std::string usage() const;
  [[noreturn]] void wrong(const std::string& message) const;
  std::string tool_, synopsis_, purpose_;
  std::vector<Entry> entries_;
};

// "30m", "90s", "2h", "45" (seconds) to seconds; "2e7" and "20000" to a count. Throw std::invalid_argument.
double parse_seconds(const std::string& text);
int64_t parse_count(const std::string& text);

// Runs a tool's main: catches what it throws, prints one line "tool: message" on stderr, returns the exit code.
int run_tool(const char* tool, int argc, char** argv, int (*body)(int argc, char** argv));

struct Command {
  const char* name;
  const char* purpose;
  int (*body)(int argc, char** argv);
};
// A tool of several commands: picks the one that argv[1] names, handles --help and --version of the tool itself.
int run_commands(const char* tool, const char* purpose, const std::vector<Command>& commands, int argc, char** argv);

}  // namespace synpo
