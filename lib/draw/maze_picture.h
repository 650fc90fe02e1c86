// Mazes on paper: one, or many as a grid with their names (Figure 9), and the signs for agent and treasures on them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "draw/canvas.h"
#include "draw/key.h"
#include "draw/place.h"
#include "world/maze.h"
#include "world/task.h"

namespace synpo {

// Colours for print; what the agent sees has its own (kPalette).
constexpr Rgb kPaperWall = {62, 70, 82}, kPaperFloor = {250, 249, 245}, kPaperGrid = {226, 224, 217}, kPaperAgent = {20, 20, 24};
extern const std::array<Rgb, kTreasures> kPaperTreasures;
extern const char* const kTreasureNames[kTreasures];

// The maze with its top left corner at (x, y), `cell` pixels a cell.
void draw_maze(Canvas& canvas, int x, int y, int cell, const Maze& maze);
// A lettered square for a treasure, a ringed disc for the agent, in the middle of `box`.
void draw_treasure(Canvas& canvas, const Box& box, int treasure);
void draw_agent(Canvas& canvas, const Box& box);
Sign treasure_sign(int treasure);

struct MapStyle {
  std::string title;
  double scale = 2;      // pixels per point
  int64_t columns = 0;   // mazes in a row; 0: a grid a little wider than high
};

// Throws kUsage for no maze.
Canvas draw_maps(const std::vector<Maze>& mazes, const MapStyle& style, const Font& font);

}  // namespace synpo
