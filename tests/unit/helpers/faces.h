// Episodes in a small maze and a small kitchen, and the faces that draw them.
#pragma once
#include <memory>
#include <vector>

#include "draw/face/film.h"
#include "draw/grid/grid_face.h"
#include "draw/kitchen/kitchen_face.h"
#include "helpers/kitchens.h"
#include "helpers/mazes.h"

namespace synpo {

// A maze without inner walls.
inline const GridFace& grid_face() {
  static const GridFace face(std::make_shared<const GridSet>(std::vector{open_maze()}));
  return face;
}

// Agent at (1, 1), R at (1, 3), B at (1, 4), the others in the last row of floor.
inline GridState grid_start() {
  GridState state;
  state.now.agent = cell(1, 1);
  state.now.treasures = {cell(1, 3), cell(1, 4), cell(14, 2), cell(14, 3), cell(14, 4)};
  return state;
}

inline EnvTask red_blue() { return {0, grid_face().world().task_index("R-B")}; }

inline Film grid_film(const std::vector<uint8_t>& actions, const GridState& from = grid_start()) {
  return play_film(grid_face().world(), red_blue(), to_world_state(from), actions, 1);
}

inline const std::vector<uint8_t> kGridSuccess = {kRight, kRight, kPick, kRight, kPick};

inline const KitchenFace& kitchen_face() {
  static const KitchenFace face(std::make_shared<const KitchenSet>(std::vector{small_kitchen()}));
  return face;
}

inline const KitchenSet& small_world() { return dynamic_cast<const KitchenSet&>(kitchen_face().world()); }

inline EnvTask kitchen_pair(const char* task) { return {0, small_world().task_index(task)}; }

// Where the objects lie is the same for every task.
inline WorldState kitchen_start() {
  Random random(7, Purpose::kEpisodeStart);
  return small_world().reset(0, random);
}

inline Film kitchen_film(const char* task, const std::vector<uint8_t>& actions) {
  return play_film(small_world(), kitchen_pair(task), kitchen_start(), actions, 0);
}

// The expert of the task that is played plays while the episode's task is another.
inline Film kitchen_film(const char* task, const char* played) {
  WorldState state = kitchen_start();
  std::vector<uint8_t> actions;
  do actions.push_back(uint8_t(small_world().expert(kitchen_pair(played), state)));
  while (!small_world().step(kitchen_pair(task), state, actions.back()).ended());
  return kitchen_film(task, actions);
}

}  // namespace synpo
