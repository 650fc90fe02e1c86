#include "world/kitchen/geometry/kitchen.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "base/hash.h"

namespace synpo {

const char* const kKitchenObjectNames[kKitchenObjects] = {"Container", "Lettuce", "Mug", "Tomato",
                                                          "Plate",     "Apple",   "Bowl"};
const char* const kKitchenReceptacleNames[kKitchenReceptacles] = {"Fridge", "Microwave", "Sink"};

namespace {

constexpr int kMaxFootprint = 4;

std::vector<std::string> lines_of(const std::string& text, const std::string& where) {
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (lines.back().ends_with('\r')) lines.back().pop_back();
    begin = end + 1;
    if (lines.size() > kMaxKitchenSide)
      fail(Exit::kData, where, ": found more than ", kMaxKitchenSide,
           " lines, expected a kitchen of at most that many");
  }
  return lines;
}

// The side of a footprint that touches least floor, which is where it leans on the wall.
int back_of(const Kitchen& kitchen, const Kitchen::Footprint& foot) {
  std::array<int, 4> floor = {};
  for (int side = 0; side < 4; ++side)
    for (int row = foot.row; row < foot.row + foot.rows; ++row)
      for (int column = foot.column; column < foot.column + foot.columns; ++column)
        floor[size_t(side)] += kitchen.at(row + kRowStep[side], column + kColumnStep[side]) == '.';
  const int front = int(std::max_element(floor.begin(), floor.end()) - floor.begin());
  return (front + 2) % 4;
}

Kitchen::Footprint find_receptacle(const Kitchen& kitchen, int receptacle, const std::string& where) {
  const char letter = kKitchenReceptacleLetters[receptacle];
  int top = kMaxKitchenSide, bottom = -1, left = kMaxKitchenSide, right = -1, cells = 0;
  for (int row = 0; row < kitchen.rows; ++row)
    for (int column = 0; column < kitchen.columns; ++column) {
      if (kitchen.at(row, column) != letter) continue;
      top = std::min(top, row);
      bottom = std::max(bottom, row);
      left = std::min(left, column);
      right = std::max(right, column);
      ++cells;
    }
  const char* name = kKitchenReceptacleNames[receptacle];
  if (cells == 0) fail(Exit::kData, where, ": found no '", letter, "', expected a ", name);
  Kitchen::Footprint foot = {top, left, bottom - top + 1, right - left + 1, 0};
  if (cells != foot.rows * foot.columns || foot.rows > kMaxFootprint || foot.columns > kMaxFootprint)
    fail(Exit::kData, where, ": the cells of the ", name, " ('", letter, "') are not one rectangle of at most ",
         kMaxFootprint, " x ", kMaxFootprint);
  foot.back = back_of(kitchen, foot);
  return foot;
}

// A cell of floor that cannot be reached from the first one, or the first one.
KitchenCell cut_off_cell(const Kitchen& kitchen) {
  std::vector<bool> reached(kitchen.text.size(), false);
  const auto index = [&](int row, int column) { return size_t(row * (kitchen.columns + 1) + column); };
  std::vector<KitchenCell> stack = {kitchen.floor.front()};
  reached[index(stack[0].row, stack[0].column)] = true;
  while (!stack.empty()) {
    const KitchenCell cell = stack.back();
    stack.pop_back();
    for (int side = 0; side < 4; ++side) {
      const int row = cell.row + kRowStep[side], column = cell.column + kColumnStep[side];
      if (kitchen.at(row, column) != '.' || reached[index(row, column)]) continue;
      reached[index(row, column)] = true;
      stack.push_back({int16_t(row), int16_t(column)});
    }
  }
  for (const KitchenCell& cell : kitchen.floor)
    if (!reached[index(cell.row, cell.column)]) return cell;
  return kitchen.floor.front();
}

}  // namespace

std::string KitchenTask::name() const {
  return std::string(kKitchenObjectNames[object]) + '-' + kKitchenReceptacleNames[receptacle];
}

Kitchen parse_kitchen(const std::string& name, const std::string& text, const std::string& where) {
  const std::vector<std::string> lines = lines_of(text, where);
  if (lines.empty()) fail(Exit::kData, where, ": found nothing, expected a kitchen's plan");
  Kitchen kitchen;
  kitchen.name = name;
  kitchen.rows = int(lines.size());
  kitchen.columns = int(std::min<size_t>(lines[0].size(), kMaxKitchenSide + 1));
  if (kitchen.columns > kMaxKitchenSide)
    fail(Exit::kData, where, ": line 1: found ", lines[0].size(), " characters, expected at most ", kMaxKitchenSide);
  for (int row = 0; row < kitchen.rows; ++row) {
    const std::string& line = lines[size_t(row)];
    if (int(line.size()) != kitchen.columns)
      fail(Exit::kData, where, ": line ", row + 1, ": found ", line.size(), " characters, expected ", kitchen.columns,
           " as in line 1");
    for (int column = 0; column < kitchen.columns; ++column) {
      const char c = line[size_t(column)];
      const auto place = [&] { return concat(where, ": line ", row + 1, ", column ", column + 1, ": "); };
      if (std::string_view("#.ctFMS").find(c) == std::string_view::npos)
        fail(Exit::kData, place(), "found ", character_text(line, size_t(column)), ", expected one of # . c t F M S");
      const bool border = row == 0 || row == kitchen.rows - 1 || column == 0 || column == kitchen.columns - 1;
      if (border && c != '#')
        fail(Exit::kData, place(), "found ", quoted(std::string(1, c)), ", expected the outer wall");
      if (c == '.') kitchen.floor.push_back({int16_t(row), int16_t(column)});
    }
    kitchen.text += line + '\n';
  }
  if (kitchen.floor.empty()) fail(Exit::kData, where, ": found no floor");
  const auto place_of = [](const KitchenCell& cell) {
    return concat("line ", cell.row + 1, ", column ", cell.column + 1);
  };
  const KitchenCell first = kitchen.floor.front(), cut_off = cut_off_cell(kitchen);
  if (cut_off.row != first.row || cut_off.column != first.column)
    fail(Exit::kData, where, ": ", place_of(cut_off), ": this floor cannot be reached from that in ", place_of(first));
  for (int i = 0; i < kKitchenReceptacles; ++i) kitchen.receptacles[size_t(i)] = find_receptacle(kitchen, i, where);
  kitchen.hash = Hash().add(kitchen.text).value();
  return kitchen;
}

}  // namespace synpo
