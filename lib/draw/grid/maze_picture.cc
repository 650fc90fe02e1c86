#include "draw/grid/maze_picture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/colour.h"
#include "draw/paper.h"

namespace synpo {

const std::array<Rgb, kTreasures> kPaperTreasures = {
    {{200, 38, 45}, {32, 90, 190}, {34, 134, 66}, {243, 146, 20}, {122, 56, 168}}};
const char* const kTreasureNames[kTreasures] = {"red", "blue", "green", "orange", "purple"};

void draw_maze(Canvas& canvas, int x, int y, int cell, const Maze& maze) {
  const int line = std::max(1, cell / 16);
  canvas.fill({x, y, kGridSide * cell, kGridSide * cell}, kPaperFloor);
  if (cell >= 8)
    for (int i = 1; i < kGridSide; ++i) {
      canvas.fill({x + i * cell - line / 2, y, line, kGridSide * cell}, kPaperGrid);
      canvas.fill({x, y + i * cell - line / 2, kGridSide * cell, line}, kPaperGrid);
    }
  std::vector<Box> walls;
  for (int at = 0; at < kGridCells; ++at)
    if (maze.wall[at]) walls.push_back(maze_grid(x, y, cell).box(at));
  canvas.fill(walls, kPaperWall);
}

void draw_treasure(Canvas& canvas, const Box& box, int treasure) {
  const int inset = std::max(1, box.width / 10);
  canvas.fill(box.inset(inset), kPaperTreasures[treasure]);
  const int size = box.width * 5 / 8;
  if (size >= 6)
    canvas.text(box.x + box.width / 2, box.y + box.height / 2, std::string(1, kTreasureLetters[treasure]), size,
                ink_on(kPaperTreasures[treasure]), Across::kCentre, Upright::kMiddle);
}

void draw_agent(Canvas& canvas, const Box& box) {
  const Point centre = box.centre();
  const double radius = box.width * 0.42;
  canvas.disc(centre, radius, kPaper);
  canvas.disc(centre, radius * 0.86, kPaperAgent);
  canvas.disc(centre, radius * 0.36, kPaper);
}

Sign treasure_sign(int treasure) {
  return [treasure](Canvas& canvas, const Box& box) { draw_treasure(canvas, box, treasure); };
}

void draw_task(Canvas& canvas, const Box& box, const Task& task) {
  const int half = box.width / 2;
  canvas.fill({box.x, box.y, half, box.height}, kPaperTreasures[task.first]);
  canvas.fill({box.x + half, box.y, box.width - half, box.height}, kPaperTreasures[task.second]);
  canvas.frame(box, 1, kInk);
}

Canvas draw_maps(const std::vector<Maze>& mazes, const MapStyle& style, const Font& font) {
  if (mazes.empty()) fail(Exit::kUsage, "no maze to draw");
  const Pixels px{style.scale};
  const int count = int(mazes.size());
  const int wished = style.columns > 0 ? int(style.columns) : int(std::lround(std::sqrt(count * 1.25)));
  const int columns = std::clamp(wished, 1, count);
  const int rows = (count + columns - 1) / columns;
  const int cell = px(count == 1 ? 14 : 6), side = kGridSide * cell;
  const int label = px(9), below = label + px(9), between = px(16), margin = px(12);
  const int width = 2 * margin + columns * side + (columns - 1) * between;
  const Heading heading(style.title, "", width - 2 * margin, style.scale, font);
  const int top = margin + heading.height();

  Canvas canvas(width, top + rows * (side + below) + (rows - 1) * px(8) + margin - px(4), font, style.scale);
  heading.draw(canvas, margin, margin);
  std::vector<std::string> names;
  for (const Maze& maze : mazes) names.push_back(maze.name);
  names = font.fitted_apart(names, label, side + between - px(4));
  for (int i = 0; i < count; ++i) {
    const int x = margin + i % columns * (side + between), y = top + i / columns * (side + below + px(8));
    draw_maze(canvas, x, y, cell, mazes[i]);
    canvas.text(x + side / 2, y + side + px(6), names[size_t(i)], label, kInk, Across::kCentre);
  }
  return canvas;
}

}  // namespace synpo
