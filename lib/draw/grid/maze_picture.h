// Mazes on paper: one, or many as a grid with their names (Figure 9), and the signs for agent and treasures on them.
#pragma once
#include <array>
#include <vector>

#include "base/rgb.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/canvas/key.h"
#include "draw/face/plan_grid.h"
#include "draw/map_style.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"

namespace synpo {

// For print; what the agent sees has kPalette.
extern const std::array<Rgb, kTreasures> kPaperTreasures;
extern const char* const kTreasureNames[kTreasures];

// Where the cells of a maze lie that is drawn there.
inline PlanGrid maze_grid(int x, int y, int cell) { return {x, y, cell, kGridSide}; }
// The maze with its top left corner at (x, y), `cell` pixels a cell.
void draw_maze(Canvas& canvas, int x, int y, int cell, const Maze& maze);
// A lettered square for a treasure, a ringed disc for the agent, in the middle of `box`.
void draw_treasure(Canvas& canvas, const Box& box, int treasure);
void draw_agent(Canvas& canvas, const Box& box);
Sign treasure_sign(int treasure);
// A square of the colours of the treasures: left the first, right the second.
void draw_task(Canvas& canvas, const Box& box, const Task& task);

// Throws kUsage for no maze.
Canvas draw_maps(const std::vector<Maze>& mazes, const MapStyle& style, const Font& font);

}  // namespace synpo
