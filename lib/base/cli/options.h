// Command lines: a table of options, --help and --version for every tool, one place that turns errors into a message
// and an exit code.
//
// Options are read as GNU's getopt_long reads them: -n 5, -n5, -qn5, --count 5, --count=5, any beginning of a name that
// no other option shares; options and operands in any order, whatever POSIXLY_CORRECT says; operands alone after --.
// Names are spelled as in Britain, and read in America's spelling too: --colour and --color.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"

namespace synpo {

class Options {
 public:
  // `synopsis` is what follows the tool's name; `purpose` one or two lines for --help.
  Options(std::string tool, std::string synopsis, std::string purpose);

  // `letter` may be 0. `help` is one line; the default is read from `value` and shown. An argument outside the range
  // given, or that is no number, or that is empty, is a usage error (64) that says what was found and what is expected.
  Options& flag(char letter, const char* name, const std::string& help, bool& value);
  // --NAME and --no-NAME. The older spelling --NAME 1 and --NAME 0 is read as well.
  Options& toggle(const char* name, const std::string& help, bool& value);
  Options& toggle(const char* name, const std::string& help, std::function<void(bool)> set);
  // Of int, int64_t or uint64_t; up to INT64_MAX.
  template <class Integer>
  Options& integer(char letter, const char* name, const char* arg, const std::string& help, Integer& value, int64_t low,
                   int64_t high);
  Options& real(char letter, const char* name, const char* arg, const std::string& help, double& value, double low,
                double high);
  Options& text(char letter, const char* name, const char* arg, const std::string& help, std::string& value);
  // One of these words; any other is a usage error that names them.
  Options& choice(char letter, const char* name, const char* arg, const std::string& help, std::string& value,
                  std::vector<std::string> words);
  // Calls `set` with the argument; std::invalid_argument thrown by it is a usage error that names the option.
  Options& call(char letter, const char* name, const char* arg, const std::string& help,
                std::function<void(const std::string&)> set);
  // Those that mean the same everywhere: -s, -j and -q.
  Options& seed(uint64_t& value, const std::string& help = "seed", const char* arg = "N");
  Options& threads(int& value,
                   const std::string& help = "threads; 0: as many as there are; results don't depend on it");
  Options& quiet(bool& value, const std::string& help = "no progress");
  // A shell completes the argument of the option added last with these, though it may be another.
  Options& suggest(const std::vector<std::string>& words);
  // --help shows this as the default of the option added last, in place of the value's own.
  Options& shown_as(const std::string& default_text);
  // A heading in --help above the options that follow.
  Options& section(const char* title);
  // A line of --help about a command of the tool.
  Options& command(const char* name, const char* purpose);

  // Returns the operands. Between `least` and `most` are accepted. Prints and exits 0 on --help and --version.
  std::vector<std::string> parse(int argc, char** argv, int least = 0, int most = 0);
  // True when the option was given on the command line.
  bool given(const char* name) const;
  // Throws kUsage where any option but `name` and these `others` was given.
  void alone(const char* name, const std::vector<std::string>& others) const;
  // The tool and the options that were given, in their order, but for those named, as a shell reads them.
  std::string given_again(const std::vector<std::string>& without) const;

  // Throws kUsage with the message and where to find help.
  [[noreturn]] void wrong(const std::string& message) const;

  // The table of options for scripts/completions, which --list-options prints: lines of fields with tabs between,
  // "command NAME PURPOSE" and "option -LETTER --NAME ARGUMENT WORDS HELP", an empty field where there is none.
  std::string table() const;

  // The text of --help in lines of at most `width` columns where words allow.
  std::string usage(size_t width) const;

 private:
  enum class Kind { kHeading, kCommand, kFlag, kToggle, kArgument };
  struct Entry {
    Kind kind;
    char letter;
    std::string name, arg, help, shown_default;
    std::function<void(const std::string&)> set;
    bool given = false;
    std::vector<std::string> words = {};  // that the argument may be, some of them or all
  };
  // An option as it stands on the command line; `off`: as --no-NAME.
  struct Found {
    Entry* entry;
    bool off;
  };
  struct Given {
    const Entry* entry;
    std::string argument;
  };
  // The words of the command line that are left.
  struct Words {
    char **next, **end;
    const char* take() { return next < end ? *next++ : nullptr; }
  };
  Options& add(Kind kind, char letter, const std::string& name, const char* arg, const std::string& help,
               std::function<void(const std::string&)> set);
  Found find(const std::string& name);
  void take_long(const std::string& word, Words& words);
  void take_letters(const std::string& word, Words& words);
  void set(Entry& entry, const std::string& argument);
  std::string tool_, synopsis_, purpose_;
  std::vector<Entry> entries_;
  std::vector<Given> given_;
};

// The file that an option or an operand names, `path` where neither does. Throws kUsage where both do.
std::string one_file(const Options& options, const char* option, const std::string& path,
                     const std::vector<std::string>& operands);
// A stream may be read from so many files.
constexpr int kMostStreamFiles = 1000;

// "30m", "90s", "2h", "45" (seconds) to seconds; "2e7" and "20000" to a count; a finite number. Throw
// std::invalid_argument.
double parse_seconds(const std::string& text);
int64_t parse_count(const std::string& text);
double parse_number(const std::string& text);

// A tool says this about failures of a cause: `words`, with the library's message in place of {}. It may name the
// tool's options.
struct Advice {
  Cause cause;
  const char* words;
};

// Runs a tool's main, with signals, standard descriptors and the uses of files as every tool has them: catches what it
// throws, prints one line "tool: message" on stderr, returns the exit code.
int run_tool(const char* tool, int argc, char** argv, int (*body)(int argc, char** argv),
             const std::vector<Advice>& advice = {});

struct Command {
  const char* name;
  const char* purpose;
  int (*body)(int argc, char** argv);
  std::vector<Advice> advice = {};
};
// A tool of several commands: picks the one that argv[1] names; handles --help and --version of the tool itself, `help`
// and `help COMMAND`.
int run_commands(const char* tool, const char* purpose, const std::vector<Command>& commands, int argc, char** argv);

}  // namespace synpo
