#include "world/grid/grid_set.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.h"
#include "world/grid/gridworld.h"
#include "world/grid/view.h"

namespace synpo {
namespace {

constexpr char kAgentName[] = "agent";

std::string treasure_name(int i) { return std::string(1, kTreasureLetters[i]); }

std::pair<int, int> place(int cell) { return {cell / kGridSide, cell % kGridSide}; }

// The free cell that `places` gives under `name`.
uint8_t start_cell(const Maze& maze, const StartPlaces& places, const std::string& name) {
  const auto found = places.find(name);
  if (found == places.end()) fail(Exit::kData, "field 'start': no place for ", quoted(name));
  const auto [row, column] = found->second;
  if (row < 0 || column < 0 || row >= kGridSide || column >= kGridSide || maze.wall[row * kGridSide + column])
    fail(Exit::kData, "field 'start': ", quoted(name), " at row ", row, ", column ", column, " is not on the floor of ",
         maze.name);
  return uint8_t(row * kGridSide + column);
}

WorldFacts grid_facts() {
  return {.name = "gridworld",
          .rules = kGridRules,
          .tasks = grid_task_names(),
          .actions = {kGridActionNames, kGridActionNames + kGridActions},
          .moves = kPick,
          .state_bytes = kGridStateBytes,
          .observation = grid_observation_spec()};
}

}  // namespace

GridSet::GridSet(std::vector<Maze> mazes) : World(grid_facts()), mazes_(std::move(mazes)) {
  for (const Maze& maze : mazes_) {
    add_environment({maze.name, maze.hash, maze.canonical_text()});
    planners_.emplace_back(maze);
  }
}

GridSet GridSet::open(const std::string& world) { return GridSet(open_mazes(world)); }

WorldState GridSet::reset(int env, Random& random) const { return to_world_state(grid_reset(mazes_[env], random)); }

WorldStep GridSet::step(EnvTask pair, WorldState& state, int action) const {
  GridState grid = to_grid_state(state);
  const WorldStep step = grid_step(mazes_[pair.env], task(pair), grid, action);
  state = to_world_state(grid);
  return step;
}

int GridSet::expert(EnvTask pair, const WorldState& state) const {
  return planners_[pair.env].action(task(pair), to_grid_state(state));
}

void GridSet::action_values(EnvTask pair, const WorldState& state, int* cents) const {
  const std::array<int, kGridActions> q = planners_[pair.env].q_cents(task(pair), to_grid_state(state));
  std::copy(q.begin(), q.end(), cents);
}

bool GridSet::at_choice(EnvTask, const WorldState& state) const {
  return treasure_under_agent(to_grid_state(state).now) >= 0;
}

void GridSet::observe(int env, const StateHistory& history, int window, uint8_t* observation) const {
  draw_history(mazes_[env], history, window, observation);
}

StartPlaces GridSet::start_places(int, const WorldState& start) const {
  const GridFrame frame = to_grid_state(start).now;
  StartPlaces places = {{kAgentName, place(frame.agent)}};
  for (int i = 0; i < kTreasures; ++i) places[treasure_name(i)] = place(frame.treasures[i]);
  return places;
}

WorldState GridSet::start_state(int env, const StartPlaces& places) const {
  const Maze& maze = mazes_[env];
  GridState start;
  start.now.agent = start_cell(maze, places, kAgentName);
  for (int i = 0; i < kTreasures; ++i) {
    start.now.treasures[i] = start_cell(maze, places, treasure_name(i));
    for (int j = 0; j < i; ++j)
      if (start.now.treasures[i] == start.now.treasures[j])
        fail(Exit::kData, "field 'start': two treasures on one cell");
  }
  if (places.size() != 1 + kTreasures)
    fail(Exit::kData, "field 'start': found ", places.size(), " places, expected the agent's and those of ", kTreasures,
         " treasures");
  return to_world_state(start);
}

bool GridSet::valid(EnvTask pair, const WorldState& state) const {
  const GridState grid = to_grid_state(state);
  const Maze& maze = mazes_[pair.env];
  if (grid.picked > 1 || grid.steps >= kStepLimit || maze.wall[grid.now.agent] || to_world_state(grid) != state)
    return false;
  for (int i = 0; i < kTreasures; ++i) {
    const bool gone = grid.picked == 1 && i == task(pair).first;
    if (gone != (grid.now.treasures[i] == kPicked) || (!gone && maze.wall[grid.now.treasures[i]])) return false;
  }
  return true;
}

const GridSet& as_gridworld(const World& world, const std::string& what) {
  const GridSet* grid = dynamic_cast<const GridSet*>(&world);
  if (!grid) fail(Exit::kUsage, what, " needs gridworld, found world ", quoted(world.name()));
  return *grid;
}

}  // namespace synpo
