#include "world/kitchen/builtin_kitchens.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "world/kitchen/geometry/make_tables.h"
#include "world/kitchen/geometry/ray.h"
#include "world/kitchen/geometry/tables.h"
#include "world/kitchen/planner.h"

namespace synpo {
namespace {

struct Size {
  int number, floor;  // of FloorPlan, and of its free cells
};
constexpr Size kSizes[] = {{1, 129}, {2, 115}, {3, 104}, {4, 69},   {5, 99},  {6, 134},  {8, 172},
                           {9, 76},  {11, 67}, {12, 79}, {18, 222}, {20, 80}, {22, 136}, {23, 96},
                           {24, 61}, {25, 27}, {27, 43}, {28, 101}, {30, 59}};

constexpr int kDepth = 2;       // of counters, in cells
constexpr int kLargeRoom = 90;  // free cells from which on something stands in the middle
constexpr int kFewestSlots = 14;
constexpr int kAttempts = 200000;

class Draft {
 public:
  Draft(int rows, int columns) : rows_(rows), columns_(columns), cells_(size_t(rows * columns), '.') {}

  char& at(int row, int column) { return cells_[size_t(row * columns_ + column)]; }
  void fill(int row, int column, int rows, int columns, char c) {
    for (int r = row; r < row + rows; ++r)
      for (int k = column; k < column + columns; ++k) at(r, k) = c;
  }
  bool all(int row, int column, int rows, int columns, char c) {
    if (row < 0 || column < 0 || row + rows > rows_ || column + columns > columns_) return false;
    for (int r = row; r < row + rows; ++r)
      for (int k = column; k < column + columns; ++k)
        if (at(r, k) != c) return false;
    return true;
  }
  int floor() const { return int(std::count(cells_.begin(), cells_.end(), '.')); }
  std::string text() {
    std::string text(size_t(columns_ + 2), '#');
    text += '\n';
    for (int row = 0; row < rows_; ++row) {
      text += '#';
      for (int column = 0; column < columns_; ++column) text += at(row, column);
      text += "#\n";
    }
    return text + std::string(size_t(columns_ + 2), '#') + '\n';
  }
  int rows() const { return rows_; }
  int columns() const { return columns_; }

 private:
  int rows_, columns_;
  std::string cells_;
};

int between(Random& random, int low, int high) { return low + int(random.below(uint32_t(high - low + 1))); }
bool chance(Random& random, int percent) { return int(random.below(100)) < percent; }

// A corner that belongs to the room next door.
void cut_corner(Draft& draft, Random& random) {
  const int rows = between(random, 2, draft.rows() / 2), columns = between(random, 2, draft.columns() / 2);
  const bool south = chance(random, 50), east = chance(random, 50);
  draft.fill(south ? draft.rows() - rows : 0, east ? draft.columns() - columns : 0, rows, columns, '#');
}

// A run of counter along one of the outer walls; walls in its way cut it.
void put_counter(Draft& draft, Random& random, int side) {
  const bool sideways = side % 2;
  const int length = sideways ? draft.rows() : draft.columns();
  const int run = chance(random, 50) ? length : between(random, std::min(length, 4), length);
  const int begin = chance(random, 50) ? 0 : length - run;
  for (int along = begin; along < begin + run; ++along)
    for (int out = 0; out < kDepth; ++out) {
      char& cell = sideways ? draft.at(along, side == 1 ? draft.columns() - 1 - out : out)
                            : draft.at(side == 2 ? draft.rows() - 1 - out : out, along);
      if (cell == '.') cell = 'c';
    }
}

// An island or a table with room to walk around it; false where it does not fit.
bool put_island(Draft& draft, Random& random) {
  constexpr int kAisle = 3;
  int rows = between(random, 2, 4), columns = between(random, 3, 6);
  if (chance(random, 50)) std::swap(rows, columns);
  const int free_rows = draft.rows() - rows - 2 * kAisle, free_columns = draft.columns() - columns - 2 * kAisle;
  if (free_rows < 0 || free_columns < 0) return false;
  const int row = kAisle + between(random, 0, free_rows), column = kAisle + between(random, 0, free_columns);
  if (!draft.all(row - kAisle, column - kAisle, rows + 2 * kAisle, columns + 2 * kAisle, '.')) return false;
  draft.fill(row, column, rows, columns, chance(random, 60) ? 't' : 'c');
  return true;
}

// Puts a receptacle into a counter along an outer wall with floor all along its front; false where none of some tries
// fits.
bool put_receptacle(Draft& draft, Random& random, char letter, int width) {
  for (int i = 0; i < 12; ++i) {
    const int side = between(random, 0, 3);
    const bool sideways = side % 2;
    const int length = sideways ? draft.rows() : draft.columns(), depth = sideways ? draft.columns() : draft.rows();
    if (length < width || depth <= kDepth) continue;
    const int along = between(random, 0, length - width), out = side == 1 || side == 2 ? depth - kDepth : 0;
    const int front = side == 1 || side == 2 ? out - 1 : kDepth;
    const bool fits = sideways ? draft.all(along, out, width, kDepth, 'c') && draft.all(along, front, width, 1, '.')
                               : draft.all(out, along, kDepth, width, 'c') && draft.all(front, along, 1, width, '.');
    if (!fits) continue;
    if (sideways)
      draft.fill(along, out, width, kDepth, letter);
    else
      draft.fill(out, along, kDepth, width, letter);
    return true;
  }
  return false;
}

// A plan of the wanted size, or an empty text where this attempt gives none.
std::string attempt(const Size& size, Random& random) {
  const int most = 2 * kDepth + int(1.6 * std::sqrt(double(size.floor)));
  const int rows = between(random, 5, most), columns = between(random, 5, most);
  if (rows * columns < size.floor + 12 || rows * columns > 2 * size.floor + 50) return {};
  Draft draft(rows, columns);
  if (chance(random, size.floor < 60 ? 20 : 45)) cut_corner(draft, random);
  const int first = between(random, 0, 3), runs = between(random, 2, 3);
  for (int i = 0; i < runs; ++i) put_counter(draft, random, (first + i) % 4);
  if (size.floor >= kLargeRoom && !put_island(draft, random)) return {};
  if (draft.floor() != size.floor) return {};
  for (int i = 0; i < kKitchenReceptacles; ++i)
    if (!put_receptacle(draft, random, kKitchenReceptacleLetters[i], i == kMicrowave ? 2 : 3)) return {};
  return draft.text();
}

bool good(const Kitchen& kitchen) {
  const KitchenSolids solids(kitchen);
  const KitchenTables tables = kitchen_tables(kitchen, solids);
  if (int(tables.slots.size()) < kFewestSlots) return false;
  const KitchenPlanner planner(kitchen.name, tables);
  return true;
}

Kitchen make(const Size& size) {
  const std::string name = "FloorPlan" + std::to_string(size.number);
  for (uint64_t i = 0; i < kAttempts; ++i) {
    Random random(uint64_t(size.number), Purpose::kInit, 0, i);
    const std::string text = attempt(size, random);
    if (text.empty()) continue;
    // Drafts in which floor is cut off or a thing is out of reach are found out as those of others are.
    try {
      Kitchen kitchen = parse_kitchen(name, text, name);
      if (good(kitchen)) return kitchen;
    } catch (const Error& error) {
      if (error.code() != Exit::kData) throw;
    }
  }
  fail(Exit::kInternal, "found no plan for ", name);
}

}  // namespace

const std::vector<Kitchen>& builtin_kitchens() {
  static const std::vector<Kitchen> kitchens = [] {
    std::vector<Kitchen> all;
    for (const Size& size : kSizes) all.push_back(make(size));
    return all;
  }();
  return kitchens;
}

}  // namespace synpo
