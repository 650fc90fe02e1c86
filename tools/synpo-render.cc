// synpo-render: matrices, curves, mazes, kitchens, views, episodes, embeddings and policies as pictures.
#include "render/render.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "advice.h"
#include "base/cli/options.h"
#include "base/error.h"
#include "base/files/io.h"
#include "base/random.h"
#include "base/text.h"
#include "draw/canvas/canvas.h"
#include "draw/canvas/font.h"
#include "draw/episode/agent_view.h"
#include "draw/face/film.h"
#include "draw/face/world_face.h"
#include "draw/map_style.h"
#include "draw/plot/curves.h"
#include "draw/terminal/terminal.h"
#include "draw/worlds/faces.h"
#include "format/checkpoint.h"
#include "play/model.h"
#include "stats/matrix/heat_table.h"
#include "world/grid/maze.h"
#include "world/world.h"

using namespace synpo;

namespace {

int map(int argc, char** argv) {
  MapStyle style;
  PictureOptions picture;
  WorldOptions world;
  Options options("synpo-render map", "[OPTION]... [NAME]...",
                  "Draws mazes or kitchens: the ones named, else all, as a grid with their names.");
  world.add_to(options);
  options.call(0, "title", "TEXT", "title above the picture", drawn(style.title))
      .integer(0, "columns", "N", "mazes in a row; 0: a grid a little wider than high", style.columns, 0, 1000);
  picture.add_ansi(options);
  picture.add_to(options);
  const auto names = options.parse(argc, argv, 0, 1000);
  picture.settle(options);
  style.scale = picture.scale;
  const std::unique_ptr<const WorldFace> face = world.open(options);
  std::vector<int> envs(names.empty() ? size_t(face->world().envs()) : 0);
  std::iota(envs.begin(), envs.end(), 0);
  for (const std::string& name : names) envs.push_back(find_env(*face, name));
  Output output = picture.open();
  if (picture.ansi)
    finish(output, face->plans_text(envs, style, picture.colour.of(output), picture.width(output)));
  else {
    const Font font(picture.font);
    picture.finish(output, face->draw_plans(envs, style, font));
  }
  return 0;
}

int view(int argc, char** argv) {
  ViewStyle style;
  PictureOptions picture;
  WorldOptions world;
  std::string env, task;
  int64_t seed = 0, episode = 0, steps = 0, window = 1;
  Options options("synpo-render view", "[OPTION]...",
                  "Draws a moment of an expert's episode and what the agent sees of it.");
  world.add_to(options);
  options.text('e', "env", "NAME", "maze or kitchen; none: the world's first", env)
      .text('t', "task", "NAME", "task; none: the world's first, R-B or Container-Fridge", task)
      .integer('s', "seed", "N", "seed of the start", seed, 0, INT64_MAX)
      .integer(0, "episode", "N", "number of the episode under this seed", episode, 0, UINT32_MAX)
      .integer(0, "steps", "N", "steps of the expert from the start", steps, 0, kStepLimit)
      .integer(0, "window", "R", "radius of what the agent sees of a maze; 0: blind", window, 0, kGridSide - 1)
      .flag(0, "history", "the last four pictures of the network's input too", style.history)
      .call(0, "title", "TEXT", "title instead of environment, task and step", drawn(style.title));
  picture.add_to(options);
  options.parse(argc, argv);
  picture.settle(options);
  style.scale = picture.scale;
  const std::unique_ptr<const WorldFace> face = world.open(options);
  if (!face->kind().has_window && options.given("window"))
    fail(Exit::kUsage, "--window is for ", environments_with(&FaceKind::has_window), ", but the world is ",
         quoted(face->world().name()));
  if (!options.given("window")) window = world.window;
  Output output = picture.open();
  const Font font(picture.font);
  const EnvTask pair = {env.empty() ? 0 : find_env(*face, env), task.empty() ? 0 : find_task(*face, task)};
  const Random random(uint64_t(seed), Purpose::kEpisodeStart, face->world().pair_number(pair), uint64_t(episode));
  picture.finish(output,
                 draw_agent_view(*face, expert_film(face->world(), pair, random, steps, int(window)), style, font));
  return 0;
}

int body(int argc, char** argv) {
  return run_commands("synpo-render",
                      "Draws success matrices, learning curves, mazes, kitchens, views, episodes, embeddings and "
                      "policies as PNG, PDF or SVG; runs networks over views.",
                      {{"heatmap", "success matrices", heatmap, {{kSeveralMethods, "{}: choose one with --method"}}},
                       {"curves",
                        "run logs as curves",
                        curves,
                        {{kNoRoomForAxes, "{}: give a larger --size"}, {kMarkOutside, "{}: give another --y-range"}}},
                       {"map", "mazes and kitchens", map},
                       {"view", "what the agent sees", view},
                       {"episode", "a trajectory as a path through its maze or kitchen", episode, {kSeeWorld}},
                       {"embedding", "a checkpoint's environments and tasks", embedding},
                       {"policy", "what a checkpoint does in every cell, against the planner", policy},
                       {"features", "scene files of kitchens, their views seen by a feature network", features}},
                      argc, argv);
}

}  // namespace

std::unique_ptr<const WorldFace> WorldOptions::open(const Options& options) {
  if (checkpoint.empty()) return open_face(name);
  if (options.given("world")) fail(Exit::kUsage, "-w and -c exclude each other");
  const Checkpoint loaded = load_checkpoint(checkpoint);
  window = int(loaded.window);
  return face_of(world_of(loaded));
}

int find_env(const WorldFace& face, const std::string& name, const char* world) {
  const int found = face.world().env_index(name);
  if (found < 0)
    fail(Exit::kUsage, "no ", face.kind().environment, " ", quoted(name), " in ", world,
         did_you_mean(name, face.world().env_names()));
  return found;
}

int find_task(const WorldFace& face, const std::string& name) {
  const int found = face.world().task_index(name);
  const char* hint = face.kind().task_hint;
  if (found < 0)
    fail(Exit::kUsage, "no task ", quoted(name), hint ? ": expected " : " in this world", hint ? hint : "",
         did_you_mean(name, face.world().task_names()));
  return found;
}

int main(int argc, char** argv) {
  return run_tool("synpo-render", argc, argv, body,
                  {{kPictureTooLarge, "{}: use a smaller --scale"}, {kNoFont, "{} with --font or SYNPO_FONT"}});
}
