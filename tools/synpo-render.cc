// synpo-render: matrices, curves, mazes, kitchens, views, episodes, embeddings and policies as PNG pictures.
#include "render/render.h"

#include <algorithm>

#include "base/error.h"
#include "draw/grid/agent_view.h"
#include "draw/grid/maze_picture.h"
#include "draw/kitchen/kitchen_agent_view.h"
#include "draw/kitchen/kitchen_picture.h"
#include "draw/terminal/terminal.h"
#include "world/grid/maze.h"
#include "world/grid/task.h"
#include "world/kitchen/plan.h"

using namespace synpo;

namespace {

constexpr char kWorldHelp[] = "gridworld, gridworld:DIR for the map files of a folder, or kitchen";

template <class Plan>
const Plan& find_plan(const std::vector<Plan>& plans, const std::string& name, const char* kind) {
  const auto found = std::find_if(plans.begin(), plans.end(), [&](const Plan& plan) { return plan.name == name; });
  if (found == plans.end()) fail(Exit::kUsage, "no ", kind, " ", quoted(name), " in this world");
  return *found;
}

template <class Plan>
std::vector<Plan> choose_plans(const std::vector<Plan>& plans, const std::vector<std::string>& names,
                               const char* kind) {
  if (names.empty()) return plans;
  std::vector<Plan> chosen;
  for (const std::string& name : names) chosen.push_back(find_plan(plans, name, kind));
  return chosen;
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
  Options options("synpo-render map", "[OPTION]... [NAME]...",
                  "Draws mazes or kitchens: the ones named, else all, as a grid with their names.");
  options.text('w', "world", "WORLD", kWorldHelp, world)
      .call(0, "title", "TEXT", "title above the picture", drawn(style.title))
      .integer(0, "columns", "N", "mazes in a row; 0: a grid a little wider than high", style.columns, 0, 1000);
  picture.add_ansi(options);
  picture.add_to(options);
  const auto names = options.parse(argc, argv, 0, 1000);
  picture.check(options, {});
  style.scale = picture.scale;
  const auto finish_with = [&](const auto& plans, const auto& draw, const auto& terminal) {
    Output output = picture.open();
    if (picture.ansi)
      finish(output, terminal(plans, style, environment_colour(), terminal_width(output.is_stdout() ? 1 : -1)));
    else
      finish(output, draw(plans, style, Font(picture.font)));
  };
  if (draws_kitchens(world))
    finish_with(choose_plans(builtin_kitchens(), names, "kitchen"), draw_kitchens, terminal_kitchens);
  else
    finish_with(choose_plans(open_mazes(world), names, "maze"), draw_maps, terminal_maps);
  return 0;
}

struct ViewOptions {
  std::string world = "gridworld", env, task, title;
  int64_t seed = 0, episode = 0, steps = 0, window = 1;
  bool history = false;
  Random random(uint64_t pair) const { return {uint64_t(seed), Purpose::kEpisodeStart, pair, uint64_t(episode)}; }
};

Canvas draw_maze_view(const ViewOptions& wanted, double scale, const Font& font) {
  const std::vector<Maze> mazes = open_mazes(wanted.world);
  const Maze& maze = wanted.env.empty() ? mazes.front() : find_plan(mazes, wanted.env, "maze");
  const int task = wanted.task.empty() ? 0 : find_task(wanted.task);
  const uint64_t pair = uint64_t(&maze - mazes.data()) * grid_tasks().size() + uint64_t(task);
  const ViewStyle style = {int(wanted.window), wanted.history, wanted.title, scale};
  return draw_agent_view(expert_moment(maze, grid_tasks()[size_t(task)], wanted.random(pair), wanted.steps), style,
                         font);
}

Canvas draw_kitchen_view(const ViewOptions& wanted, double scale, const Font& font) {
  const KitchenSet world;
  const EnvTask pair = {wanted.env.empty() ? 0 : world.env_index(wanted.env),
                        wanted.task.empty() ? 0 : world.task_index(wanted.task)};
  if (pair.env < 0) fail(Exit::kUsage, "no kitchen ", quoted(wanted.env), " in this world");
  if (pair.task < 0)
    fail(Exit::kUsage, "no task ", quoted(wanted.task), ": expected an object and a receptacle, such as Mug-Sink");
  return draw_kitchen_view(kitchen_moment(world, pair, wanted.random(world.pair_number(pair)), wanted.steps),
                           {wanted.history, wanted.title, scale}, font);
}

int view(int argc, char** argv) {
  ViewOptions wanted;
  PictureOptions picture;
  Options options("synpo-render view", "[OPTION]...",
                  "Draws a moment of an expert's episode and what the agent sees of it.");
  options.text('w', "world", "WORLD", kWorldHelp, wanted.world)
      .text('e', "env", "NAME", "maze or kitchen; none: the world's first", wanted.env)
      .text('t', "task", "NAME", "task; none: the world's first, R-B or Container-Fridge", wanted.task)
      .integer('s', "seed", "N", "seed of the start", wanted.seed, 0, INT64_MAX)
      .integer(0, "episode", "N", "number of the episode under this seed", wanted.episode, 0, UINT32_MAX)
      .integer(0, "steps", "N", "steps of the expert from the start", wanted.steps, 0, kStepLimit)
      .integer(0, "window", "R", "radius of what the agent sees of a maze; 0: blind", wanted.window, 0, kGridSide - 1)
      .flag(0, "history", "the last four pictures of the network's input too", wanted.history)
      .call(0, "title", "TEXT", "title instead of environment, task and step", drawn(wanted.title));
  picture.add_to(options);
  options.parse(argc, argv);
  const bool kitchen = draws_kitchens(wanted.world);
  if (kitchen && options.given("window"))
    fail(Exit::kUsage, "--window is for mazes, but the world is ", quoted(wanted.world));
  Output output(picture.output, Output::Kind::kBinary, picture.force);
  const Font font(picture.font);
  finish(output,
         kitchen ? draw_kitchen_view(wanted, picture.scale, font) : draw_maze_view(wanted, picture.scale, font));
  return 0;
}

int body(int argc, char** argv) {
  return run_commands("synpo-render",
                      "Draws success matrices, learning curves, mazes, kitchens, views, episodes, embeddings and "
                      "policies as PNG; runs networks over views.",
                      {{"heatmap", "success matrices", heatmap},
                       {"curves", "run logs as curves", curves},
                       {"map", "mazes and kitchens", map},
                       {"view", "what the agent sees", view},
                       {"episode", "a trajectory as a path through its maze or kitchen", episode},
                       {"embedding", "a checkpoint's environments and tasks", embedding},
                       {"policy", "what a checkpoint does in every cell, against the planner", policy},
                       {"features", "scene files of kitchens, their views seen by a feature network", features}},
                      argc, argv);
}

}  // namespace

bool draws_kitchens(const std::string& world) {
  if (world == "kitchen") return true;
  if (world == "gridworld" || world.starts_with("gridworld:")) return false;
  if (world.starts_with("kitchen:"))
    fail(Exit::kUsage, "cannot draw the world ", quoted(world),
         ": of the kitchens, only those of 'kitchen' have plans");
  fail(Exit::kUsage, "unknown world ", quoted(world), ", expected gridworld, gridworld:DIR or kitchen");
}

int main(int argc, char** argv) { return run_tool("synpo-render", argc, argv, body); }
