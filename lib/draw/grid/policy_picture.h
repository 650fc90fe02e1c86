// A policy in every free cell of a maze: its best action there, against the planner's.
#pragma once
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/face/policy_stage.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"

namespace synpo {

// The stages side by side; their states are GridStates.
Canvas draw_maze_policy(const Maze& maze, const Task& task, const std::vector<PolicyStage>& stages,
                        const PolicyPictureStyle& style, const Font& font);

}  // namespace synpo
