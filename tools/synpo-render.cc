// synpo-render: matrices, curves, mazes, views, episodes, embeddings and policies as PNG pictures.
#include "synpo-render.h"

#include <algorithm>

#include "base/error.h"
#include "draw/agent_view.h"
#include "draw/maze_picture.h"
#include "draw/terminal.h"
#include "world/maze.h"
#include "world/task.h"

using namespace synpo;

namespace {

const Maze& find_maze(const std::vector<Maze>& mazes, const std::string& name) {
  const auto found = std::find_if(mazes.begin(), mazes.end(), [&](const Maze& maze) { return maze.name == name; });
  if (found == mazes.end()) fail(Exit::kUsage, "no maze ", quoted(name), " in this world");
  return *found;
}

int find_task(const std::string& name) {
  for (size_t i = 0; i < grid_tasks().size(); ++i)
    if (grid_tasks()[i].name() == name) return int(i);
  fail(Exit::kUsage, "no task ", quoted(name), ": expected two of R B G O P, such as R-B");
}

int map(int argc, char** argv) {
  MapStyle style;
  PictureOptions picture;
  std::string world = "gridworld";
  Options options("synpo-render map", "[OPTION]... [NAME]...", "Draws mazes: the ones named, else all, as a grid with their names.");
  options.text('w', "world", "WORLD", "gridworld, or gridworld:DIR for the map files of a folder", world)
      .call(0, "title", "TEXT", "title above the picture", drawn(style.title))
      .integer(0, "columns", "N", "mazes in a row; 0: a grid a little wider than high", style.columns, 0, 1000);
  picture.add_ansi(options);
  picture.add_to(options);
  const auto names = options.parse(argc, argv, 0, 1000);
  picture.check(options, {});
  style.scale = picture.scale;
  std::vector<Maze> mazes = open_mazes(world);
  if (!names.empty()) {
    std::vector<Maze> chosen;
    for (const std::string& name : names) chosen.push_back(find_maze(mazes, name));
    mazes = std::move(chosen);
  }
  Output output = picture.open();
  if (picture.ansi)
    finish(output, terminal_maps(mazes, style, environment_colour(), terminal_width(output.is_stdout() ? 1 : -1)));
  else
    finish(output, draw_maps(mazes, style, Font(picture.font)));
  return 0;
}

int view(int argc, char** argv) {
  ViewStyle style;
  PictureOptions picture;
  std::string world = "gridworld", env, task = "R-B";
  int64_t seed = 0, episode = 0, steps = 0, window = style.radius;
  Options options("synpo-render view", "[OPTION]...", "Draws a moment of an expert's episode and what the agent sees of it.");
  options.text('w', "world", "WORLD", "gridworld, or gridworld:DIR for the map files of a folder", world)
      .text('e', "env", "NAME", "maze; none: the world's first", env)
      .text('t', "task", "NAME", "task", task)
      .integer('s', "seed", "N", "seed of the start", seed, 0, INT64_MAX)
      .integer(0, "episode", "N", "number of the episode under this seed", episode, 0, UINT32_MAX)
      .integer(0, "steps", "N", "steps of the expert from the start", steps, 0, kGridStepLimit)
      .integer(0, "window", "R", "radius of what the agent sees of the maze; 0: blind", window, 0, kGridSide - 1)
      .flag(0, "history", "the four pictures of the network's input too", style.history)
      .call(0, "title", "TEXT", "title instead of maze, task and step", drawn(style.title));
  picture.add_to(options);
  options.parse(argc, argv);
  style.scale = picture.scale;
  style.radius = int(window);
  const std::vector<Maze> mazes = open_mazes(world);
  const Maze& maze = env.empty() ? mazes.front() : find_maze(mazes, env);
  const int task_index = find_task(task);
  const uint64_t pair = uint64_t(&maze - mazes.data()) * grid_tasks().size() + uint64_t(task_index);
  Output output(picture.output, Output::Kind::kBinary, picture.force);
  const Random random(uint64_t(seed), Purpose::kEpisodeStart, pair, uint64_t(episode));
  finish(output, draw_agent_view(expert_moment(maze, grid_tasks()[task_index], random, steps), style, Font(picture.font)));
  return 0;
}

int body(int argc, char** argv) {
  return run_commands("synpo-render", "Draws success matrices, learning curves, mazes, views, episodes, embeddings and policies as PNG; runs networks over views.",
                      {{"heatmap", "success matrices", heatmap},
                       {"curves", "run logs as curves", curves},
                       {"map", "mazes", map},
                       {"view", "what the agent sees", view},
                       {"episode", "a trajectory as a path through its maze", episode},
                       {"embedding", "a checkpoint's environments and tasks", embedding},
                       {"policy", "what a checkpoint does in every cell, against the planner", policy},
                       {"features", "scene files of kitchens, their views seen by a feature network", features}},
                      argc, argv);
}

}  // namespace

int main(int argc, char** argv) { return run_tool("synpo-render", argc, argv, body); }
