// Figure 1: a moment of an episode as the reader sees it, and beside it what the agent sees.
#pragma once
#include <string>

#include "draw/canvas/canvas.h"
#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"
#include "world/grid/view.h"

namespace synpo {

// A moment of an episode. `history` holds its pictures up to now.
struct ViewMoment {
  const Maze& maze;
  Task task;
  GridState state;
  StateHistory history;
  int expert_action = -1;  // what the expert does next; -1 after the end
};

// The start of the episode that `random` draws, followed by `steps` steps of the expert. Throws kUsage when its episode
// is shorter.
ViewMoment expert_moment(const Maze& maze, const Task& task, Random random, int64_t steps);

// What the agent sees, cell for cell in the colours of the network's input, `cell` pixels a cell; nullptr: nothing, all
// black.
void draw_seen(Canvas& canvas, int x, int y, int cell, const Maze& maze, const GridFrame* frame, int radius);

struct ViewStyle {
  int radius = 1;
  bool history = false;  // the four pictures that the network gets, in a row beneath
  std::string title;     // empty: maze, task and step in words
  double scale = 2;      // pixels per point
};

Canvas draw_agent_view(const ViewMoment& moment, const ViewStyle& style, const Font& font);

}  // namespace synpo
