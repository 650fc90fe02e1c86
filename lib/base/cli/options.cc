#include "base/cli/options.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/cli/screen.h"
#include "base/cli/version.h"
#include "base/error.h"
#include "base/files/descriptor.h"
#include "base/files/file_uses.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "base/text.h"

namespace synpo {

std::string version_text() {
  const std::string commit = kCommit;
  return kVersion + (commit.empty() ? "" : " (git " + commit + ")");
}

namespace {

[[noreturn]] void print_and_exit(const std::string& text) {
  write_file("-", text, Output::Kind::kText);
  std::exit(0);
}

// Of --help: as wide as the terminal, but no wider than is easily read; and what is no terminal.
size_t help_width() {
  constexpr int kNarrowest = 40, kWidest = 120, kElsewhere = 80;
  const int columns = screen_size(1).columns;
  return size_t(columns > 0 ? std::clamp(columns, kNarrowest, kWidest) : kElsewhere);
}

// The name in America's spelling.
std::string american(std::string name) {
  constexpr const char* kSpellings[][2] = {{"colour", "color"}, {"normalise", "normalize"}};
  for (const auto& [here, there] : kSpellings)
    if (const size_t at = name.find(here); at != std::string::npos) name.replace(at, std::strlen(here), there);
  return name;
}

// All tools say this.
const std::vector<Advice> kCommonAdvice = {{kTerminalInput, "{} (see --help)"},
                                           {kTerminalOutput, "{}: use -o FILE, or -f to force it"}};

// The error that was thrown, in the tool's own words.
Error advised(const Error& error, const std::vector<Advice>& advice) {
  for (const Advice& one : advice) {
    if (!error.has(one.cause)) continue;
    std::string words = one.words;
    return {error.code(), words.replace(words.find("{}"), 2, error.what())};
  }
  return error;
}

}  // namespace

double parse_number(const std::string& text) {
  double value = 0;
  if (!parse_whole(text, value) || !std::isfinite(value)) throw std::invalid_argument("expected a number");
  return value;
}

double parse_seconds(const std::string& text) {
  const char unit = text.empty() ? 0 : text.back();
  const double scale = unit == 'h' ? 3600 : unit == 'm' ? 60 : unit == 's' ? 1 : 0;
  double value = 0;
  if (!parse_whole(std::string_view(text).substr(0, text.size() - (scale > 0)), value))
    throw std::invalid_argument("expected a time such as 90s, 30m or 2h");
  if (!(value > 0 && value < 1e8))
    throw std::invalid_argument("expected a time such as 90s, 30m or 2h, its number over 0 and under 1e8");
  return value * (scale > 0 ? scale : 1);
}

int64_t parse_count(const std::string& text) {
  int64_t value = 0;
  if (parse_whole(text, value)) return value;
  try {
    const double real = parse_number(text);
    if (std::abs(real) < 0x1p53 && real == std::floor(real)) return int64_t(real);
  } catch (const std::invalid_argument&) {
  }
  throw std::invalid_argument("expected a whole number");
}

Options::Options(std::string tool, std::string synopsis, std::string purpose)
    : tool_(std::move(tool)), synopsis_(std::move(synopsis)), purpose_(std::move(purpose)) {}

Options& Options::add(Kind kind, char letter, const std::string& name, const char* arg, const std::string& help,
                      std::function<void(const std::string&)> set) {
  entries_.push_back({kind, letter, name, arg, help, "", std::move(set)});
  return *this;
}

Options& Options::shown_as(const std::string& default_text) {
  entries_.back().shown_default = default_text;
  return *this;
}

Options& Options::call(char letter, const char* name, const char* arg, const std::string& help,
                       std::function<void(const std::string&)> set) {
  return add(Kind::kArgument, letter, name, arg, help, std::move(set));
}

Options& Options::flag(char letter, const char* name, const std::string& help, bool& value) {
  return add(Kind::kFlag, letter, name, "", help, [&value](const std::string&) { value = true; });
}

Options& Options::toggle(const char* name, const std::string& help, std::function<void(bool)> set) {
  return add(Kind::kToggle, 0, name, "", help, [set = std::move(set)](const std::string& text) {
    if (text != "0" && text != "1") throw std::invalid_argument("expected 0 or 1");
    set(text == "1");
  });
}

Options& Options::toggle(const char* name, const std::string& help, bool& value) {
  return toggle(name, help, [&value](bool on) { value = on; }).shown_as(value ? "on" : "off");
}

template <class Integer>
Options& Options::integer(char letter, const char* name, const char* arg, const std::string& help, Integer& value,
                          int64_t low, int64_t high) {
  return call(letter, name, arg, help,
              [&value, low, high](const std::string& text) {
                const std::string expected = concat("expected a whole number from ", low, " to ", high);
                int64_t given = 0;
                try {
                  given = parse_count(text);
                } catch (const std::invalid_argument&) {
                  throw std::invalid_argument(expected);
                }
                if (given < low || given > high) throw std::invalid_argument(expected);
                value = Integer(given);
              })
      .shown_as(std::to_string(value));
}
template Options& Options::integer(char, const char*, const char*, const std::string&, int&, int64_t, int64_t);
template Options& Options::integer(char, const char*, const char*, const std::string&, int64_t&, int64_t, int64_t);
template Options& Options::integer(char, const char*, const char*, const std::string&, uint64_t&, int64_t, int64_t);

Options& Options::seed(uint64_t& value, const std::string& help, const char* arg) {
  return integer('s', "seed", arg, help, value, 0, INT64_MAX);
}

Options& Options::threads(int& value, const std::string& help) {
  return integer('j', "threads", "N", help, value, 0, 1024);
}

Options& Options::quiet(bool& value, const std::string& help) { return flag('q', "quiet", help, value); }

Options& Options::real(char letter, const char* name, const char* arg, const std::string& help, double& value,
                       double low, double high) {
  return call(letter, name, arg, help,
              [&value, low, high](const std::string& text) {
                if (!parse_whole(text, value) || !(value >= low && value <= high))
                  throw std::invalid_argument(concat("expected a number from ", shortest(low), " to ", shortest(high)));
                value += 0.0;  // -0 is 0, also where it names a run
              })
      .shown_as(shortest(value));
}

Options& Options::choice(char letter, const char* name, const char* arg, const std::string& help, std::string& value,
                         std::vector<std::string> words) {
  call(letter, name, arg, help, [&value, words](const std::string& given) {
    if (std::find(words.begin(), words.end(), given) == words.end())
      throw std::invalid_argument("expected " + alternatives(words));
    value = given;
  }).shown_as(value);
  entries_.back().words = std::move(words);
  return *this;
}

Options& Options::text(char letter, const char* name, const char* arg, const std::string& help, std::string& value) {
  return call(letter, name, arg, help, [&value](const std::string& given) { value = given; }).shown_as(value);
}

Options& Options::suggest(const std::vector<std::string>& words) {
  entries_.back().words = words;
  return *this;
}

std::string Options::table() const {
  std::string out;
  for (const Entry& entry : entries_) {
    if (entry.kind == Kind::kHeading) continue;
    if (entry.kind == Kind::kCommand) {
      out += concat("command\t", entry.name, '\t', entry.help, '\n');
      continue;
    }
    std::string words;
    for (const std::string& word : entry.words) words += (words.empty() ? "" : " ") + word;
    const std::string letter = entry.letter ? std::string("-") + entry.letter : "";
    const std::string rest = concat('\t', entry.arg, '\t', words, '\t', entry.help, '\n');
    out += concat("option\t", letter, "\t--", entry.name, rest);
    if (entry.kind == Kind::kToggle) out += concat("option\t\t--no-", entry.name, rest);
  }
  return out;
}

Options& Options::section(const char* title) { return add(Kind::kHeading, 0, title, "", "", nullptr); }

Options& Options::command(const char* name, const char* purpose) {
  return add(Kind::kCommand, 0, name, "", purpose, nullptr);
}

std::string Options::usage(size_t width) const {
  constexpr size_t kColumn = 30, kCommandColumn = 14, kNarrow = 70, kNarrowColumn = 8;
  const std::string usage = "usage: ";
  std::string out =
      usage + wrapped(tool_ + (synopsis_.empty() ? "" : " ") + synopsis_, usage.size(), usage.size(), width);
  out += "\n" + wrapped(purpose_, 0, 0, width) + "\n";
  if (!entries_.empty() && entries_[0].kind != Kind::kHeading) out += "\n";
  const auto add_row = [&](const std::string& left, size_t column, const std::string& help) {
    const bool fits = left.size() + 2 <= column && width >= kNarrow;
    const size_t indent = width >= kNarrow ? column : kNarrowColumn;
    out += left + (fits ? std::string(column - left.size(), ' ') : "\n" + std::string(indent, ' '));
    out += wrapped(help, indent, indent, width) + "\n";
  };
  for (const Entry& entry : entries_) {
    if (entry.kind == Kind::kHeading) {
      out += "\n" + wrapped(entry.name + ":", 0, 0, width) + "\n";
      continue;
    }
    if (entry.kind == Kind::kCommand) {
      add_row("  " + entry.name, kCommandColumn, entry.help);
      continue;
    }
    std::string left = (entry.letter ? std::string("  -") + entry.letter + ", --" : "      --") + entry.name;
    if (entry.kind == Kind::kToggle) left += ", --no-" + entry.name;
    if (entry.kind == Kind::kArgument) left += " " + entry.arg;
    add_row(left, kColumn, entry.help + (entry.shown_default.empty() ? "" : " [" + entry.shown_default + "]"));
  }
  return out;
}

void Options::wrong(const std::string& message) const { fail(Exit::kUsage, message, "; try '", tool_, " --help'"); }

Options::Found Options::find(const std::string& name) {
  std::vector<std::string> candidates, all;
  Found found{};
  for (Entry& entry : entries_) {
    if (entry.kind == Kind::kHeading || entry.kind == Kind::kCommand) continue;
    for (const bool off : {false, true}) {
      if (off && entry.kind != Kind::kToggle) continue;
      const std::string full = (off ? "no-" : "") + entry.name, abroad = american(full);
      if (full == name || abroad == name) return {&entry, off};
      all.push_back("--" + full);
      if (!full.starts_with(name) && !abroad.starts_with(name)) continue;
      candidates.push_back("--" + full);
      found = {&entry, off};
    }
  }
  const std::string given = "--" + name;
  if (candidates.empty()) wrong("unknown option " + quoted(given) + did_you_mean(given, all));
  if (candidates.size() > 1) wrong("ambiguous option " + quoted(given) + ": " + alternatives(candidates));
  return found;
}

void Options::set(Entry& entry, const std::string& argument) {
  entry.given = true;
  given_.push_back({&entry, argument});
  try {
    entry.set(argument);
    // A name may be any text, but none is not a name.
    if (entry.kind == Kind::kArgument && argument.empty()) throw std::invalid_argument("expected " + entry.arg);
  } catch (const std::invalid_argument& error) {
    wrong(concat("option --", entry.name, ": found ", quoted(argument), ", ", error.what()));
  }
}

void Options::take_long(const std::string& word, Words& words) {
  const size_t equals = word.find('=');
  const bool has_value = equals != std::string::npos;
  const std::string value = has_value ? word.substr(equals + 1) : "";
  const auto [entry, off] = find(word.substr(0, equals));
  if (has_value && (off || entry->kind == Kind::kFlag))
    wrong(concat("option --", off ? "no-" : "", entry->name, " takes no value, found ", quoted(value)));
  if (has_value) return set(*entry, value);
  if (entry->kind == Kind::kArgument) {
    const char* next = words.take();
    if (!next) wrong(concat("option --", entry->name, " needs an argument"));
    return set(*entry, next);
  }
  // --NAME 1 is older than --no-NAME.
  double number = 0;
  const bool older = entry->kind == Kind::kToggle && !off && words.next < words.end && parse_whole(*words.next, number);
  set(*entry, older ? words.take() : off ? "0" : "1");
}

void Options::take_letters(const std::string& word, Words& words) {
  for (size_t i = 1; i < word.size(); ++i) {
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.letter == word[i]; });
    if (entry == entries_.end()) wrong(concat("unknown option -", word[i]));
    if (entry->kind != Kind::kArgument) {
      if (i + 1 < word.size() && word[i + 1] == '=')
        wrong(concat("option -", word[i], " takes no value, found ", quoted(word.substr(i + 2))));
      set(*entry, "");
      continue;
    }
    if (i + 1 < word.size()) return set(*entry, word.substr(i + 1));
    const char* next = words.take();
    if (!next) wrong(concat("option -", word[i], " needs an argument"));
    return set(*entry, next);
  }
}

std::vector<std::string> Options::parse(int argc, char** argv, int least, int most) {
  add(Kind::kFlag, 'h', "help", "", "this text", [this](const std::string&) { print_and_exit(usage(help_width())); });
  add(Kind::kFlag, 0, "version", "", "the version", [this](const std::string&) {
    print_and_exit(tool_.substr(0, tool_.find(' ')) + " (synpo) " + version_text() + "\n");
  });
  if (argc == 2 && argv[1] == std::string("--list-options")) print_and_exit(table());
  std::vector<std::string> operands;
  Words words{argv + std::min(argc, 1), argv + argc};
  while (const char* next = words.take()) {
    const std::string word = next;
    if (word == "--") {
      operands.insert(operands.end(), words.next, words.end);
      break;
    }
    if (word.starts_with("--"))
      take_long(word.substr(2), words);
    else if (word.size() > 1 && word[0] == '-')
      take_letters(word, words);
    else
      operands.push_back(word);
  }
  if (int(operands.size()) > most) wrong("unexpected operand " + quoted(operands[most]));
  if (int(operands.size()) < least) wrong("an operand is missing");
  return operands;
}

bool Options::given(const char* name) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == name && e.given; });
}

void Options::alone(const char* name, const std::vector<std::string>& others) const {
  for (const auto& [entry, argument] : given_)
    if (entry->name != name && std::find(others.begin(), others.end(), entry->name) == others.end())
      fail(Exit::kUsage, "--", name, " does not go with --", entry->name);
}

std::string one_file(const Options& options, const char* option, const std::string& path,
                     const std::vector<std::string>& operands) {
  if (operands.empty()) return path;
  if (options.given(option))
    options.wrong(concat(quoted(path), " is given by --", option, ", ", quoted(operands[0]),
                         " as an operand: expected one of them"));
  return operands[0];
}

std::string Options::given_again(const std::vector<std::string>& without) const {
  std::string line = tool_;
  for (const auto& [entry, argument] : given_) {
    if (std::find(without.begin(), without.end(), entry->name) != without.end()) continue;
    const bool off = entry->kind == Kind::kToggle && argument == "0";
    line += entry->letter ? std::string(" -") + entry->letter : concat(" --", off ? "no-" : "", entry->name);
    if (entry->kind == Kind::kArgument) line += " " + shell_quoted(argument);
  }
  return line;
}

int run_tool(const char* tool, int argc, char** argv, int (*body)(int argc, char** argv),
             const std::vector<Advice>& advice) {
  const auto report = [&](Exit code, const char* message) {
    // Messages name what files and command lines hold: no byte of that may act on the terminal.
    std::fprintf(stderr, "%s: %s\n", tool, printable(message).c_str());
    return int(code);
  };
  prepare_signals();
  try {
    open_standard_descriptors();
    const FileUses uses;
    return body(argc, argv);
  } catch (const Error& error) {
    return report(error.code(), advised(advised(error, advice), kCommonAdvice).what());
  } catch (const Stopped& stopped) {
    if (stopped.signal == SIGPIPE) end_by_signal(SIGPIPE);
    return 128 + stopped.signal;
  } catch (const std::bad_alloc&) {
    return report(Exit::kInternal, "out of memory");
  } catch (const std::exception& error) {
    return report(Exit::kInternal, error.what());
  }
}

int run_commands(const char* tool, const char* purpose, const std::vector<Command>& commands, int argc, char** argv) {
  const std::string see_help = concat("; try '", tool, " --help'");
  const auto find = [&](const std::string& name) {
    std::vector<std::string> names;
    for (const Command& command : commands) {
      if (name == command.name) return command;
      names.emplace_back(command.name);
    }
    fail(Exit::kUsage, "unknown command ", quoted(name), did_you_mean(name, names), see_help);
  };
  const bool asks = argc >= 2 && argv[1] == std::string("help");
  std::string help = "--help";
  char* help_only[] = {argv[0], help.data(), nullptr};
  if (asks && argc > 3) fail(Exit::kUsage, "unexpected operand ", quoted(argv[3]), see_help);
  if (asks && argc == 3) return find(argv[2]).body(2, help_only);
  if (argc >= 2 && argv[1][0] != '-' && !asks) {
    const Command command = find(argv[1]);
    try {
      return command.body(argc - 1, argv + 1);
    } catch (const Error& error) {
      throw advised(error, command.advice);
    }
  }
  Options options(tool, "COMMAND [OPTION]...", purpose);
  options.section(concat("commands (see '", tool, " help COMMAND')").c_str());
  for (const Command& command : commands) options.command(command.name, command.purpose);
  options.section("options");
  if (asks)
    options.parse(2, help_only);
  else
    options.parse(argc, argv);
  fail(Exit::kUsage, "a command is missing", see_help);
}

}  // namespace synpo
