#include "world/grid/maze.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/files/io.h"
#include "base/hash.h"
#include "base/text.h"
#include "world/grid/builtin_maps.h"

namespace synpo {
namespace {

// A cell of floor that cannot be reached from the first one; -1 where there is none.
int cut_off_cell(const Maze& maze) {
  std::vector<bool> reached(kGridCells, false);
  std::vector<int> stack = {maze.free_cells.front()};
  reached[stack.front()] = true;
  while (!stack.empty()) {
    const int cell = stack.back();
    stack.pop_back();
    for (const int next : {cell - kGridSide, cell + kGridSide, cell - 1, cell + 1})
      if (!maze.wall[next] && !reached[next]) {
        reached[next] = true;
        stack.push_back(next);
      }
  }
  for (const int cell : maze.free_cells)
    if (!reached[cell]) return cell;
  return -1;
}

std::string place_of(int cell) { return concat("line ", cell / kGridSide + 1, ", column ", cell % kGridSide + 1); }

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    begin = end + 1;
  }
  while (!lines.empty() && lines.back().find_first_not_of(' ') == std::string::npos) lines.pop_back();
  return lines;
}

}  // namespace

std::string Maze::canonical_text() const {
  std::string text;
  for (int cell = 0; cell < kGridCells; ++cell) {
    text += wall[cell] ? '#' : '@';
    if (cell % kGridSide == kGridSide - 1) text += '\n';
  }
  return text;
}

Maze parse_maze(const std::string& name, const std::string& text, const std::string& where) {
  const auto bad = [&](const auto&... what) { fail(Exit::kData, where, ": ", what...); };
  if (text.starts_with(std::string_view("\xff\xfe\0\0", 4)) || text.starts_with(std::string_view("\0\0\xfe\xff", 4)))
    bad("found UTF-32, expected plain ASCII text");
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) bad("found UTF-16, expected plain ASCII text");
  if (const size_t cr = text.find('\r'); cr != std::string::npos && text.find('\n') == std::string::npos)
    bad("lines end in CR alone, expected LF or CR LF");
  const std::vector<std::string> lines = split_lines(text);
  // Before lines and characters are counted: what cannot be seen is found nowhere else.
  for (size_t row = 0; row < lines.size(); ++row)
    for (size_t at = 0, column = 1; at < lines[row].size(); ++column) {
      const char c = lines[row][at];
      if (c != '#' && c != ' ' && c != '@')
        bad("line ", row + 1, ", column ", column, ": found ", character_text(lines[row], at),
            ", expected '#' (wall), ' ' or '@' (floor)");
      at += std::max<size_t>(1, utf8_length(lines[row], at));
    }
  if (lines.empty())
    bad("found ", text.empty() ? "nothing" : "blanks alone", ", expected a maze of ", kGridSide, " lines of ",
        kGridSide, " characters");
  const auto inside = lines.begin() + std::ptrdiff_t(std::min<size_t>(lines.size(), kGridSide));
  if (const auto empty = std::find(lines.begin(), inside, ""); empty != inside)
    bad("line ", empty - lines.begin() + 1, ": found an empty line, expected ", kGridSide, " characters");
  if (lines.size() != kGridSide)
    bad("found ", lines.size(), " lines, expected a maze of ", kGridSide, " lines of ", kGridSide, " characters");
  Maze maze;
  maze.name = name;
  for (int row = 0; row < kGridSide; ++row) {
    std::string line = lines[row];
    line.erase(std::min(line.size(), std::max<size_t>(kGridSide, line.find_last_not_of(' ') + 1)));
    if (line.size() > kGridSide) bad("line ", row + 1, ": found ", line.size(), " characters, expected ", kGridSide);
    for (int column = 0; column < kGridSide; ++column) {
      // Editors drop blanks at the end of a line: what is missing is floor, and the outer wall where it would stand in
      // it.
      const bool border = row == 0 || row == kGridSide - 1 || column == 0 || column == kGridSide - 1;
      const char c = column < int(line.size()) ? line[column] : border ? '#' : ' ';
      const int cell = row * kGridSide + column;
      if (border && c != '#') bad(place_of(cell), ": found floor, expected the outer wall");
      maze.wall[cell] = c == '#';
      if (c != '#') maze.free_cells.push_back(uint8_t(cell));
    }
  }
  if (maze.free_cells.size() < 6) bad("found ", maze.free_cells.size(), " floor cells, expected at least 6");
  if (const int cell = cut_off_cell(maze); cell >= 0)
    bad(place_of(cell), ": this floor cannot be reached from that in ", place_of(maze.free_cells.front()));
  maze.hash = Hash().add(maze.canonical_text()).value();
  return maze;
}

const std::vector<Maze>& builtin_mazes() {
  static const std::vector<Maze> mazes = [] {
    std::vector<Maze> all;
    for (const BuiltinMap& map : kBuiltinMaps) all.push_back(parse_maze(map.name, map.text, map.name));
    std::sort(all.begin(), all.end(), [](const Maze& a, const Maze& b) { return natural_less(a.name, b.name); });
    return all;
  }();
  return mazes;
}

std::vector<Maze> open_mazes(const std::string& world) {
  static const std::string name = "gridworld", prefix = name + ":";
  if (world == name) return builtin_mazes();
  if (world.starts_with(prefix)) return load_mazes(world.substr(prefix.size()));
  fail(Exit::kUsage, "unknown world ", quoted(world), ", expected gridworld or gridworld:DIR");
}

std::vector<Maze> load_mazes(const std::string& folder) {
  constexpr std::string_view kEnding = ".txt";
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(kEnding) && !name.starts_with('.')) names.push_back(name);
  }
  if (error) fail(Exit::kNoInput, "cannot read the folder '", folder, "': ", error.message());
  if (names.empty()) fail(Exit::kNoInput, "no *", kEnding, " in the folder '", folder, "'");
  std::sort(names.begin(), names.end(), natural_less);
  const auto stem = [&](const std::string& name) { return name.substr(0, name.size() - kEnding.size()); };
  for (const std::string& name : names)
    if (const std::string fault = fault_of_name(stem(name)); !fault.empty())
      fail(Exit::kData, quoted(name), " in the folder '", folder, "': ", fault);
  std::vector<Maze> mazes;
  for (const std::string& name : names) {
    const std::string path = (fs::path(folder) / name).string();
    Input input(path);
    mazes.push_back(parse_maze(stem(name), input.rest(1 << 16), path));
  }
  return mazes;
}

}  // namespace synpo
