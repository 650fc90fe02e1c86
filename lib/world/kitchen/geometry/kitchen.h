// Kitchens: plans of cells of 0.25 m as text, one character a cell, and the names of their things.
//
// '#' wall   '.' floor   'c' counter   't' table   'F' Fridge   'M' Microwave   'S' Sink
//
// Each receptacle is one rectangle. The text is all that makes a kitchen what it is: geometry, places for objects,
// colours and tables follow from it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace synpo {

constexpr float kCellMetres = 0.25f;
constexpr int kMaxKitchenSide = 40;  // cells, outer walls included

constexpr int kKitchenObjects = 7;
constexpr int kKitchenReceptacles = 3;
constexpr int kKitchenDoors = 2;  // the first receptacles, which open and close
constexpr int kKitchenTasks = kKitchenObjects * kKitchenReceptacles;
extern const char* const kKitchenObjectNames[kKitchenObjects];  // in the order of Table 1
extern const char* const kKitchenReceptacleNames[kKitchenReceptacles];
constexpr char kKitchenReceptacleLetters[kKitchenReceptacles + 1] = "FMS";

enum KitchenReceptacle : uint8_t { kFridge, kMicrowave, kSink };

// "Put object into receptacle"; tasks stand in the order of objects, then receptacles.
struct KitchenTask {
  int object, receptacle;
  std::string name() const;  // "Mug-Sink"
};
inline KitchenTask kitchen_task(int task) { return {task / kKitchenReceptacles, task % kKitchenReceptacles}; }

struct KitchenCell {
  int16_t row, column;
  bool operator==(const KitchenCell&) const = default;
};

struct Kitchen {
  struct Footprint {
    int row, column, rows, columns;
    int back;  // heading in quarter turns from north of the side away from the floor
  };

  std::string name;
  std::string text;  // canonical: lines of equal length, each ended by a newline
  uint64_t hash;     // of `text`
  int rows, columns;
  std::vector<KitchenCell> floor;  // row by row; all connected
  std::array<Footprint, kKitchenReceptacles> receptacles;

  char at(int row, int column) const { return text[size_t(row) * size_t(columns + 1) + size_t(column)]; }
};

// Row and column of the next cell in a direction, in quarter turns clockwise from north (row 0).
constexpr int kRowStep[4] = {-1, 0, 1, 0}, kColumnStep[4] = {0, 1, 0, -1};

// Parses a plan; a carriage return before the end of a line and the last newline may be there or not. `where` names the
// source in messages. Throws kData for lines of different length, more than kMaxKitchenSide rows or columns, a foreign
// character, an outer wall with a hole, a receptacle that is not one rectangle of at most 4 x 4 cells, or floor that is
// missing or not connected.
Kitchen parse_kitchen(const std::string& name, const std::string& text, const std::string& where);

}  // namespace synpo
