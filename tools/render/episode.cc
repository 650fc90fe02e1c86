// synpo-render episode: a trajectory as a path through its maze or kitchen, and what the agent saw on the way.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>

#include "base/error.h"
#include "base/files/folder.h"
#include "base/signals.h"
#include "draw/canvas/video.h"
#include "draw/grid/episode_picture.h"
#include "draw/grid/terminal_path.h"
#include "draw/kitchen/kitchen_episode_picture.h"
#include "play/stream.h"
#include "render/render.h"
#include "world/grid/grid_set.h"
#include "world/kitchen/kitchen_set.h"

using namespace synpo;

namespace {

struct Read {
  Episode episode;
  int window;
};

Read read_episode(Input& input, const World& world, int64_t line) {
  TrajectoryStream stream(input, world, {});
  const uint64_t before = stream.length_up_to(uint64_t(line - 1));
  const std::optional<Episode> episode = stream.next();
  if (!episode)
    fail(Exit::kData, input.name(), ": it ends after ", before, before == 1 ? " line" : " lines", ", before line ",
         line);
  return {*episode, stream.window()};
}

// What is made of an episode: the picture, a frame for the start and after every step, or text. `font` may be null
// where only text is wanted.
struct Drawing {
  std::shared_ptr<const World> world;  // what the others draw
  int steps;
  std::function<Canvas()> picture;
  std::function<Canvas(int)> frame;
  std::function<std::string(TerminalColour)> text;
};

Drawing maze_drawing(const std::string& world_name, Input& input, int64_t line, const EpisodeStyle& style,
                     const Font* font) {
  const auto world = std::make_shared<const GridSet>(GridSet::open(world_name));
  const Read read = read_episode(input, *world, line);
  const EnvTask pair = read.episode.pair;
  const auto film =
      std::make_shared<const Film>(play_film(world->maze(pair.env), world->tasks()[size_t(pair.task)],
                                             to_grid_state(read.episode.start), read.episode.actions, read.window));
  return {world, film->steps(), [=] { return draw_episode(*film, style, *font); },
          [=](int i) { return draw_episode_frame(*film, i, style, *font); },
          [film](TerminalColour colour) { return terminal_path(*film, colour); }};
}

Drawing kitchen_drawing(Input& input, int64_t line, const EpisodeStyle& style, const Font* font) {
  const auto world = std::make_shared<const KitchenSet>();
  const Read read = read_episode(input, *world, line);
  const auto film = std::make_shared<const KitchenFilm>(
      play_kitchen_film(*world, read.episode.pair, read.episode.start, read.episode.actions));
  return {world, film->steps(), [=] { return draw_kitchen_episode(*film, style, *font); },
          [=](int i) { return draw_kitchen_frame(*film, i, style, *font); }, nullptr};
}

void write_frames(const std::string& path, const Drawing& drawing) {
  OutputFolder folder(path);
  for (int i = 0; i <= drawing.steps; ++i) {
    stop_if_asked();
    char name[32];
    std::snprintf(name, sizeof name, "%04d.png", i);
    folder.write(name, drawing.frame(i).png());
  }
  folder.finish();
}

void write_video(const std::string& path, double rate, const Drawing& drawing) {
  std::unique_ptr<Video> video;
  for (int i = 0; i <= drawing.steps; ++i) {
    stop_if_asked();
    const Canvas frame = drawing.frame(i);
    if (!video) video = std::make_unique<Video>(path, rate, frame.width(), frame.height());
    video->add(frame);
  }
  video->finish();
}

}  // namespace

int episode(int argc, char** argv) {
  EpisodeStyle style;
  PictureOptions picture;
  std::string world_name = "gridworld", frames, video;
  int64_t line = 1;
  double rate = 8;
  bool ansi = false;
  Options options(
      "synpo-render episode", "[OPTION]... [TRAJECTORIES]",
      "Draws an episode as a path through its maze or kitchen, from light to dark, and what the agent saw on the way.");
  options.text('w', "world", "WORLD", "gridworld, gridworld:DIR for the map files of a folder, or kitchen", world_name)
      .integer(0, "line", "N", "the episode's line", line, 1, INT64_MAX)
      .integer(0, "strip", "N", "pictures of what the agent saw: the first, picks, the last, others between; 0: none",
               style.strip, 0, kStepLimit)
      .call(0, "title", "TEXT", "title instead of environment and task", drawn(style.title))
      .section("instead of the picture")
      .flag(0, "ansi", "the path through a maze as text, in coloured blocks on a terminal that has colours", ansi)
      .text(0, "frames", "DIR", "a folder of numbered PNG files, one for the start and one after every step", frames)
      .text(0, "video", "FILE", "the same as a video: .avi, or .mp4, .mkv where OpenCV can", video)
      .real(0, "rate", "HZ", "the video's frames per second", rate, 0.1, 240);
  picture.add_to(options);
  const auto operands = options.parse(argc, argv, 0, 1);
  const bool kitchen = draws_kitchens(world_name), draws_films = !frames.empty() || !video.empty();
  if (ansi && draws_films) fail(Exit::kUsage, "--ansi goes without --frames and --video");
  if (ansi && kitchen) fail(Exit::kUsage, "--ansi is for mazes, but the world is ", quoted(world_name));
  if (draws_films && options.given("output"))
    fail(Exit::kUsage, "--frames and --video take the place of the picture, but -o is given");
  if (options.given("rate") && video.empty()) fail(Exit::kUsage, "--rate is for --video");
  style.scale = picture.scale;
  if (draws_films) catch_stop_signals();

  std::unique_ptr<Output> output;
  if (!draws_films)
    output =
        std::make_unique<Output>(picture.output, ansi ? Output::Kind::kText : Output::Kind::kBinary, picture.force);
  Input input(operands.empty() ? "-" : operands[0]);
  std::unique_ptr<const Font> font;
  if (!ansi) font = std::make_unique<const Font>(picture.font);
  const Drawing drawing = kitchen ? kitchen_drawing(input, line, style, font.get())
                                  : maze_drawing(world_name, input, line, style, font.get());
  if (ansi) {
    finish(*output, drawing.text(terminal_colour(output->is_stdout() ? 1 : -1)));
    return 0;
  }
  if (!frames.empty()) write_frames(frames, drawing);
  if (!video.empty()) write_video(video, rate, drawing);
  if (output) finish(*output, drawing.picture());
  return 0;
}
