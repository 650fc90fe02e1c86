#include "draw/terminal/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "draw/shortened.h"
#include "stats/report/text_table.h"

namespace synpo {
namespace {

constexpr size_t kLeastLabel = 16;  // columns that a task's name may have, however many environments there are

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// The nearest colour of the 6 x 6 x 6 cube.
int cube_index(Rgb colour) {
  const auto level = [](int value) {
    constexpr int levels[] = {0, 95, 135, 175, 215, 255};
    const auto nearer = [&](int a, int b) { return std::abs(a - value) < std::abs(b - value); };
    return int(std::min_element(std::begin(levels), std::end(levels), nearer) - std::begin(levels));
  };
  return 16 + 36 * level(colour.r) + 6 * level(colour.g) + level(colour.b);
}

std::vector<std::string> characters(const std::string& text) {
  const std::vector<size_t> starts = character_starts(text);
  std::vector<std::string> all;
  for (size_t i = 0; i + 1 < starts.size(); ++i) all.push_back(text.substr(starts[i], starts[i + 1] - starts[i]));
  return all;
}

std::string right(const std::string& text, size_t width) {
  const size_t taken = columns_of(text);
  return taken < width ? std::string(width - taken, ' ') + text : text;
}

// "map" of map1, map2, map10; "" where what that leaves of a name is nothing, or has no room in a cell.
std::string common_stem(const std::vector<std::string>& names, size_t cell) {
  std::string stem = names[0].substr(0, names[0].find_first_of("0123456789"));
  for (const std::string& name : names)
    if (!name.starts_with(stem) || name.size() == stem.size() || columns_of(name) - columns_of(stem) >= cell) return "";
  return stem;
}

// Marks the kinds of pairs where there is no colour.
char mark_of(const HeatTable& table, int group) {
  const std::string& name = table.groups[group].name;
  return name == "seen" ? ' ' : name == "unseen" ? '*' : name[0];
}

// The same of pairs alone: seen ones stand out.
char split_mark(const HeatTable& table, int group) {
  const std::string& name = table.groups[group].name;
  return name == "seen" ? '#' : name == "unseen" ? '.' : name[0];
}

// Names across: what they share in the corner and the rest above their columns, or else read downwards.
std::string head(const HeatTable& table, size_t label, size_t cell) {
  constexpr int kMostLines = 12;
  const std::string stem = common_stem(table.envs, cell);
  std::string text;
  if (!stem.empty()) {
    text = right(fitted(stem, by_columns(), int(label)), label);
    for (const std::string& env : table.envs) text += right(env.substr(stem.size()), cell);
    return text + '\n';
  }
  std::vector<std::vector<std::string>> names;
  size_t lines = 0;
  Ruler downwards = by_columns();
  downwards.width_of = [](const std::string& name) { return int(characters(name).size()); };
  for (const std::string& env : fitted_apart(table.envs, downwards, kMostLines)) {
    names.push_back(characters(env));
    lines = std::max(lines, names.back().size());
  }
  for (size_t line = 0; line < lines; ++line) {
    text += std::string(label, ' ');
    for (const auto& name : names) {
      const size_t skipped = lines - std::min(lines, name.size());
      text += right(line < skipped ? " " : name[line - skipped], cell);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

TerminalColour forced_colour() {
  const std::string depth = variable("COLORTERM");
  return depth == "truecolor" || depth == "24bit" ? TerminalColour::kTrue : TerminalColour::k256;
}

TerminalColour environment_colour() {
  const std::string term = variable("TERM");
  return !variable("NO_COLOR").empty() || term.empty() || term == "dumb" ? TerminalColour::kNone : forced_colour();
}

TerminalColour terminal_colour(int fd) { return isatty(fd) ? environment_colour() : TerminalColour::kNone; }

std::string ground_code(Rgb ground, TerminalColour colour) {
  if (colour == TerminalColour::kNone) return "";
  const int ink = ink_on(ground).r == 0 ? 16 : 231;
  if (colour == TerminalColour::k256) return concat("\033[38;5;", ink, ";48;5;", cube_index(ground), 'm');
  return concat("\033[38;5;", ink, ";48;2;", int(ground.r), ';', int(ground.g), ';', int(ground.b), 'm');
}

std::string ink_code(Rgb ink, TerminalColour colour) {
  if (colour == TerminalColour::kNone) return "";
  if (colour == TerminalColour::k256) return concat("\033[38;5;", cube_index(ink), 'm');
  return concat("\033[38;2;", int(ink.r), ';', int(ink.g), ';', int(ink.b), 'm');
}

std::string terminal_matrix(const HeatTable& named, const Scheme& scheme, TerminalColour colour, int width) {
  HeatTable table = named;
  table.caption = printable(table.caption);
  for (auto* names : {&table.tasks, &table.envs})
    for (std::string& name : *names) name = printable(name);
  const bool coloured = colour != TerminalColour::kNone;
  size_t cell = 4;
  if (width > 0) {
    const size_t cells = 1 + cell * table.envs.size(), room = size_t(width) > cells ? size_t(width) - cells : 0;
    table.tasks = fitted_apart(table.tasks, by_columns(), int(std::max(room, kLeastLabel)));
  }
  size_t label = std::max<size_t>(4, std::min(kLeastLabel, columns_of(common_stem(table.envs, cell))));
  for (const std::string& task : table.tasks) label = std::max(label, columns_of(task));
  while (coloured && width > 0 && cell > 1 && label + 1 + cell * table.envs.size() > size_t(width)) --cell;
  std::string text = table.caption.empty() ? "" : table.caption + '\n';
  text += head(table, coloured ? label + 1 : label, cell);  // names above the numbers, not the marks
  for (size_t task = 0; task < table.tasks.size(); ++task) {
    text += table.tasks[task] + std::string(label + 1 - columns_of(table.tasks[task]), ' ');
    std::string line;
    for (size_t env = 0; env < table.envs.size(); ++env) {
      const HeatCell& at = table.at(task, env);
      if (table.split && at.group >= 0) {
        if (coloured)
          line += ground_code(ramp_colour(group_ramp(table, at.group, scheme), kSplitShade), colour) +
                  std::string(cell, ' ') + kPlainCode;
        else
          line += std::string(cell - 2, ' ') + split_mark(table, at.group) + ' ';
        continue;
      }
      if (!at.evaluated()) {
        line += std::string(cell - (coloured ? 0 : 1), ' ') + (coloured ? "" : " ");
        continue;
      }
      const std::string rate = std::to_string(whole_percent(at.successes, at.episodes));
      if (coloured)
        line += ground_code(ramp_colour(group_ramp(table, at.group, scheme), at.rate()), colour) +
                right(cell > 2 ? rate : "", cell) + kPlainCode;
      else
        line += right(rate, cell - 1) + mark_of(table, at.group);
    }
    if (!coloured) line.resize(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  text += '\n';
  for (size_t i = 0; i < table.groups.size(); ++i) {
    const HeatGroup& group = table.groups[i];
    if (table.split) {
      text += coloured ? ground_code(ramp_colour(group_ramp(table, int(i), scheme), kSplitShade), colour) + "   " +
                             kPlainCode + ' '
                       : std::string(1, split_mark(table, int(i))) + " ";
      text += concat(group.name, ": ", counted(group.members, "pair"), '\n');
      continue;
    }
    if (group.pairs == 0) continue;
    if (coloured)
      text +=
          ground_code(ramp_colour(group_ramp(table, int(i), scheme), group.rate()), colour) + "   " + kPlainCode + ' ';
    text += concat(
        group.name, coloured || mark_of(table, int(i)) == ' ' ? "" : concat(" (", mark_of(table, int(i)), ")"), ": ",
        percent(group.rate()), " % of ", counted(group.episodes, "episode"), ", ", counted(group.pairs, "pair"), '\n');
  }
  return text;
}

}  // namespace synpo
