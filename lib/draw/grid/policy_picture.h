// A policy in every free cell of a maze: its best action there, against the planner's.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "draw/canvas/canvas.h"
#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/planner.h"
#include "world/grid/task.h"

namespace synpo {

struct PolicyCell {
  uint8_t cell;
  int action;  // of the highest probability, the first of them
  double probability;
  std::array<bool, kGridActions> optimal;  // by the planner; several where ways are equally short
  bool agrees() const { return optimal[size_t(action)]; }
};

// A panel: the treasures as they lie in one stage of the task.
struct PolicyStage {
  GridState state;  // where its agent stands does not matter
  std::vector<PolicyCell> cells;
  int agreeing() const;
};

// `probabilities` are of the free cells, in the maze's order.
PolicyStage compare_to_planner(const Maze& maze, const Planner& planner, const Task& task, const GridState& state,
                               const std::vector<std::array<double, kGridActions>>& probabilities);

struct PolicyPictureStyle {
  std::string title, caption;
  double scale = 2;  // pixels per point
};

// The stages side by side.
Canvas draw_policy(const Maze& maze, const Task& task, const std::vector<PolicyStage>& stages,
                   const PolicyPictureStyle& style, const Font& font);

}  // namespace synpo
