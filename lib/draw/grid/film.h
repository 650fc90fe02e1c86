// An episode that was played, every moment of it, and the words for what came of it.
#pragma once
#include <string>
#include <vector>

#include "world/grid/gridworld.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"

namespace synpo {

struct Film {
  const Maze& maze;
  Task task;
  int radius;                     // of the agent's window
  std::vector<GridState> states;  // before every action, and after the last
  std::vector<uint8_t> actions;
  std::vector<WorldStep> results;  // of every action
  int steps() const { return int(actions.size()); }
};

// Plays the actions from the start; at least one.
Film play_film(const Maze& maze, const Task& task, const GridState& start, const std::vector<uint8_t>& actions,
               int radius);

// The treasure that action number `i`, from 0, picks; -1 where it picks none.
int treasure_picked(const Film& film, int i);

// Actions: spread_moments() with those that pick a treasure.
std::vector<int> key_moments(const Film& film, int count);

// "success", "wrong pick", "timeout" or, where the actions end before the episode does, "unfinished".
std::string outcome(const Film& film);
// "success after 41 steps (39 would do), reward 11.60; R at step 20, B at step 41; 2 steps into walls"
std::string describe(const Film& film);

}  // namespace synpo
