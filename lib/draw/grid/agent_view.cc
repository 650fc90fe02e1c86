#include "draw/grid/agent_view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "draw/canvas/heading.h"
#include "draw/canvas/key.h"
#include "draw/colour.h"
#include "draw/episode/history_row.h"
#include "draw/grid/maze_picture.h"
#include "world/grid/planner.h"

namespace synpo {
namespace {

constexpr double kCellPt = 13, kBetweenPt = 24, kMarginPt = 12, kTextPt = 9;
constexpr Rgb kWindow = {0, 150, 160};

void draw_whole(Canvas& canvas, int x, int y, int cell, const ViewMoment& moment, int radius) {
  const auto box = [&](int at) { return maze_grid(x, y, cell).box(at); };
  const GridFrame& now = moment.state.now;
  draw_maze(canvas, x, y, cell, moment.maze);
  for (int i = 0; i < kTreasures; ++i)
    if (now.treasures[i] != kPicked) draw_treasure(canvas, box(now.treasures[i]), i);
  draw_agent(canvas, box(now.agent));
  const int row = now.agent / kGridSide, column = now.agent % kGridSide;
  const int top = std::max(0, row - radius), left = std::max(0, column - radius);
  const int bottom = std::min(kGridSide - 1, row + radius), right = std::min(kGridSide - 1, column + radius);
  canvas.frame({x + left * cell, y + top * cell, (right - left + 1) * cell, (bottom - top + 1) * cell},
               std::max(2, cell / 7), kWindow);
}

std::vector<KeyEntry> key_entries(const ViewMoment& moment) {
  std::vector<KeyEntry> key;
  const auto seen = [](int colour) { return colour_sign(kPalette[colour]); };
  key.push_back({{draw_agent, seen(kAgent)}, "agent"});
  for (int i = 0; i < kTreasures; ++i) {
    const int place = i == moment.task.first ? 1 : i == moment.task.second ? 2 : 0;
    std::string name = kTreasureNames[i];
    if (place) name += moment.state.picked >= place ? " (picked)" : place == 1 ? " (pick first)" : " (pick second)";
    key.push_back({{treasure_sign(i), seen(kFirstTreasure + i)}, name});
  }
  key.push_back({{colour_sign(kPaperWall), seen(kWall)}, "wall"});
  key.push_back({{colour_sign(kPaperFloor), seen(kFloor)}, "floor"});
  key.push_back({{seen(kUnseen)}, "not seen"});
  key.push_back(
      {{[](Canvas& canvas, const Box& box) { canvas.frame(box, std::max(2, box.width / 7), kWindow); }}, "window"});
  return key;
}

std::string words(const ViewMoment& moment) {
  std::string out = concat(moment.maze.name, ", task ", moment.task.name(), ", step ", moment.state.steps);
  return out + (moment.expert_action < 0
                    ? ": success"
                    : concat("; the expert's next action: ", kGridActionNames[moment.expert_action]));
}

}  // namespace

void draw_seen(Canvas& canvas, int x, int y, int cell, const Maze& maze, const GridFrame* frame, int radius) {
  uint8_t colours[kGridCells] = {};
  if (frame) draw_view(maze, *frame, radius, colours);
  for (int at = 0; at < kGridCells; ++at) canvas.fill(maze_grid(x, y, cell).box(at), kPalette[colours[at]]);
}

ViewMoment expert_moment(const Maze& maze, const Task& task, Random random, int64_t steps) {
  const Planner planner(maze);
  ViewMoment moment{maze, task, grid_reset(maze, random), {}, -1};
  moment.history.push(to_world_state(moment.state));
  const int length = planner.steps_to_success(task, moment.state);
  if (steps > length) fail(Exit::kUsage, "the expert's episode ends after ", length, " steps, before step ", steps);
  for (int64_t i = 0; i < steps; ++i) {
    grid_step(maze, task, moment.state, planner.action(task, moment.state));
    moment.history.push(to_world_state(moment.state));
  }
  if (steps < length) moment.expert_action = planner.action(task, moment.state);
  return moment;
}

Canvas draw_agent_view(const ViewMoment& moment, const ViewStyle& style, const Font& font) {
  const auto px = [&](double pt) { return std::max(1, int(std::lround(pt * style.scale))); };
  const int cell = px(kCellPt), side = kGridSide * cell, between = px(kBetweenPt), margin = px(kMarginPt);
  const int text = px(kTextPt), heading = text + px(8);
  const int width = 2 * margin + 2 * side + between, right_x = margin + side + between;

  const HistoryRow row(2 * side + between, kGridSide, Pixels{style.scale});
  const int history_height = style.history ? px(14) + row.height() : 0;

  const Key key(key_entries(moment), width - 2 * margin, style.scale, font);
  const Heading title(style.title.empty() ? words(moment) : style.title, "", width - 2 * margin, style.scale, font);
  const int headings_y = margin + title.height(), panels_y = headings_y + heading;
  const int key_y = panels_y + side + history_height + px(14);
  Canvas canvas(width, key_y + key.height() + margin, font);

  title.draw(canvas, margin, margin);
  const int window = 2 * style.radius + 1;
  canvas.text(margin, headings_y, "(a) the maze", text, kSoftInk);
  canvas.text(right_x, headings_y, concat("(b) what the agent sees, window ", window, " x ", window), text, kSoftInk);
  draw_whole(canvas, margin, panels_y, cell, moment, style.radius);
  draw_seen(canvas, right_x, panels_y, cell, moment.maze, &moment.state.now, style.radius);

  if (style.history)
    row.draw(canvas, margin, panels_y + side + px(14), "(c) the network's input: the last four pictures",
             moment.history.count, [&](const Box& box, int i, bool missing) {
               const GridFrame frame = to_grid_state(moment.history.states[i]).now;
               draw_seen(canvas, box.x, box.y, box.width / kGridSide, moment.maze, missing ? nullptr : &frame,
                         style.radius);
             });

  key.draw(canvas, margin, key_y);
  return canvas;
}

}  // namespace synpo
