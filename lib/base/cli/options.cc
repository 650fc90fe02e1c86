#include "base/cli/options.h"

#include <getopt.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/error.h"
#include "base/files/io.h"
#include "base/signals.h"
#include "base/text.h"

namespace synpo {

const char kVersion[] = "0.1.0";

namespace {

double parse_real(const std::string& text) {
  double value = 0;
  if (!parse_whole(text, value) || !std::isfinite(value)) throw std::invalid_argument("expected a number");
  return value;
}

[[noreturn]] void print_and_exit(const std::string& text) {
  write_file("-", text, Output::Kind::kText);
  std::exit(0);
}

}  // namespace

double parse_seconds(const std::string& text) {
  const char unit = text.empty() ? 0 : text.back();
  const double scale = unit == 'h' ? 3600 : unit == 'm' ? 60 : unit == 's' ? 1 : 0;
  double value = 0;
  try {
    value = parse_real(scale > 0 ? text.substr(0, text.size() - 1) : text);
  } catch (const std::invalid_argument&) {
    value = -1;
  }
  if (!(value > 0 && value < 1e8)) throw std::invalid_argument("expected a time such as 90s, 30m or 2h");
  return value * (scale > 0 ? scale : 1);
}

int64_t parse_count(const std::string& text) {
  int64_t value = 0;
  if (parse_whole(text, value)) return value;
  try {
    const double real = parse_real(text);
    if (std::abs(real) < 0x1p53 && real == std::floor(real)) return int64_t(real);
  } catch (const std::invalid_argument&) {
  }
  throw std::invalid_argument("expected a whole number");
}

Options::Options(std::string tool, std::string synopsis, std::string purpose)
    : tool_(std::move(tool)), synopsis_(std::move(synopsis)), purpose_(std::move(purpose)) {}

Options& Options::call(char letter, const char* name, const char* arg, const char* help,
                       std::function<void(const std::string&)> set) {
  entries_.push_back({letter, name, arg ? arg : "", help, "", std::move(set)});
  return *this;
}

Options& Options::flag(char letter, const char* name, const char* help, bool& value) {
  return call(letter, name, nullptr, help, [&value](const std::string&) { value = true; });
}

Options& Options::integer(char letter, const char* name, const char* arg, const char* help, int64_t& value, int64_t low,
                          int64_t high) {
  call(letter, name, arg, help, [&value, low, high](const std::string& text) {
    value = parse_count(text);
    if (value < low || value > high)
      throw std::invalid_argument(concat("expected a whole number from ", low, " to ", high));
  });
  entries_.back().shown_default = std::to_string(value);
  return *this;
}

Options& Options::real(char letter, const char* name, const char* arg, const char* help, double& value, double low,
                       double high) {
  call(letter, name, arg, help, [&value, low, high](const std::string& text) {
    value = parse_real(text);
    if (value < low || value > high) throw std::invalid_argument(concat("expected a number from ", low, " to ", high));
  });
  entries_.back().shown_default = shortest(value);
  return *this;
}

Options& Options::choice(char letter, const char* name, const char* arg, const char* help, std::string& value,
                         std::vector<std::string> words) {
  call(letter, name, arg, help, [&value, words = std::move(words)](const std::string& given) {
    if (std::find(words.begin(), words.end(), given) == words.end())
      throw std::invalid_argument("expected " + alternatives(words));
    value = given;
  });
  entries_.back().shown_default = value;
  return *this;
}

Options& Options::text(char letter, const char* name, const char* arg, const char* help, std::string& value) {
  call(letter, name, arg, help, [&value](const std::string& given) { value = given; });
  entries_.back().shown_default = value;
  return *this;
}

Options& Options::section(const char* title) {
  entries_.push_back({0, title, "", "", "", nullptr, true});
  return *this;
}

std::string Options::usage() const {
  std::string out = "usage: " + tool_ + (synopsis_.empty() ? "" : " ") + synopsis_ + "\n" + purpose_ + "\n\n";
  constexpr size_t kColumn = 30;
  const auto row = [&](char letter, const std::string& name, const std::string& help) {
    std::string left = letter ? std::string("  -") + letter + ", --" + name : "      --" + name;
    left += left.size() + 2 > kColumn ? "\n" + std::string(kColumn, ' ') : std::string(kColumn - left.size(), ' ');
    out += left + help + "\n";
  };
  for (const Entry& entry : entries_) {
    if (entry.heading) {
      out += "\n" + entry.name + ":\n";
      continue;
    }
    row(entry.letter, entry.name + (entry.arg.empty() ? "" : " " + entry.arg),
        entry.help + (entry.shown_default.empty() ? "" : " [" + entry.shown_default + "]"));
  }
  row('h', "help", "this text");
  row(0, "version", "the version");
  return out;
}

void Options::wrong(const std::string& message) const { fail(Exit::kUsage, message, "; try '", tool_, " --help'"); }

std::vector<std::string> Options::parse(int argc, char** argv, int least, int most) {
  constexpr int kFirstLong = 1000;
  std::string letters = ":h";
  std::vector<option> longs;
  for (size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (entry.heading) continue;
    if (entry.letter) letters += std::string(1, entry.letter) + (entry.arg.empty() ? "" : ":");
    longs.push_back(
        {entry.name.c_str(), entry.arg.empty() ? no_argument : required_argument, nullptr, int(kFirstLong + i)});
  }
  longs.push_back({"help", no_argument, nullptr, 'h'});
  longs.push_back({"version", no_argument, nullptr, 1});
  longs.push_back({nullptr, 0, nullptr, 0});
  optind = 0;
  opterr = 0;
  for (int found; (found = getopt_long(argc, argv, letters.c_str(), longs.data(), nullptr)) != -1;) {
    if (found == 'h') print_and_exit(usage());
    if (found == 1) print_and_exit(tool_.substr(0, tool_.find(' ')) + " " + kVersion + "\n");
    if (found == ':') wrong(concat("option ", argv[optind - 1], " needs an argument"));
    if (found == '?')
      wrong(optopt && optopt < kFirstLong ? concat("unknown option -", char(optopt))
                                          : concat("unknown or ambiguous option ", quoted(argv[optind - 1])));
    auto entry = found >= kFirstLong ? entries_.begin() + (found - kFirstLong)
                                     : std::find_if(entries_.begin(), entries_.end(),
                                                    [&](const Entry& e) { return !e.heading && e.letter == found; });
    entry->given = true;
    const std::string given = optarg ? optarg : "";
    try {
      entry->set(given);
    } catch (const std::invalid_argument& error) {
      wrong(concat("option --", entry->name, ": found ", quoted(given), ", ", error.what()));
    }
  }
  std::vector<std::string> operands(argv + optind, argv + argc);
  if (int(operands.size()) > most) wrong("unexpected operand " + quoted(operands[most]));
  if (int(operands.size()) < least) wrong("an operand is missing");
  return operands;
}

bool Options::given(const char* name) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == name && e.given; });
}

int run_tool(const char* tool, int argc, char** argv, int (*body)(int argc, char** argv)) {
  const auto report = [&](Exit code, const char* message) {
    std::fprintf(stderr, "%s: %s\n", tool, message);
    return int(code);
  };
  // Some launchers have it ignored; a reader that went away shall end the tool without a word.
  std::signal(SIGPIPE, SIG_DFL);
  try {
    return body(argc, argv);
  } catch (const Error& error) {
    return report(error.code(), error.what());
  } catch (const Stopped& stopped) {
    return 128 + stopped.signal;
  } catch (const std::bad_alloc&) {
    return report(Exit::kInternal, "out of memory");
  } catch (const std::exception& error) {
    return report(Exit::kInternal, error.what());
  }
}

int run_commands(const char* tool, const char* purpose, const std::vector<Command>& commands, int argc, char** argv) {
  std::string list;
  for (const Command& command : commands)
    list += concat("  ", command.name, std::string(12 - std::min<size_t>(11, std::strlen(command.name)), ' '),
                   command.purpose, "\n");
  if (argc >= 2 && argv[1][0] != '-') {
    for (const Command& command : commands)
      if (argv[1] == std::string(command.name)) return command.body(argc - 1, argv + 1);
    fail(Exit::kUsage, "unknown command ", quoted(argv[1]), "; try '", tool, " --help'");
  }
  Options options(tool, "COMMAND [OPTION]...", concat(purpose, "\n\ncommands (each has its own --help):\n", list));
  options.parse(argc, argv);
  fail(Exit::kUsage, "a command is missing; try '", tool, " --help'");
}

}  // namespace synpo
