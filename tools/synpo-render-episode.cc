// synpo-render episode: a trajectory as a path through its maze, and what the agent saw on the way.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "base/folder.h"
#include "draw/episode_picture.h"
#include "draw/terminal_path.h"
#include "draw/video.h"
#include "learn/stream.h"
#include "synpo-render.h"
#include "world/grid_set.h"

using namespace synpo;

namespace {

struct Read {
  Episode episode;
  int window;
};

Read read_episode(Input& input, const GridSet& world, int64_t line) {
  TrajectoryStream stream(input, world, {});
  const uint64_t before = stream.length_up_to(uint64_t(line - 1));
  const std::optional<Episode> episode = stream.next();
  if (!episode) fail(Exit::kData, input.name(), ": it ends after ", before, before == 1 ? " line" : " lines", ", before line ", line);
  return {*episode, stream.window()};
}

void write_frames(const std::string& path, const Film& film, const EpisodeStyle& style, const Font& font) {
  OutputFolder folder(path);
  for (int i = 0; i <= film.steps(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%04d.png", i);
    folder.write(name, draw_episode_frame(film, i, style, font).png());
  }
  folder.finish();
}

void write_video(const std::string& path, double rate, const Film& film, const EpisodeStyle& style, const Font& font) {
  std::unique_ptr<Video> video;
  for (int i = 0; i <= film.steps(); ++i) {
    const Canvas frame = draw_episode_frame(film, i, style, font);
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
  Options options("synpo-render episode", "[OPTION]... [TRAJECTORIES]",
                  "Draws an episode as a path through its maze, from light to dark, and what the agent saw on the way.");
  options.text('w', "world", "WORLD", "gridworld, or gridworld:DIR for the map files of a folder", world_name)
      .integer(0, "line", "N", "the episode's line", line, 1, INT64_MAX)
      .integer(0, "strip", "N", "pictures of what the agent saw: the first, picks, the last, others between; 0: none", style.strip, 0, kGridStepLimit)
      .text(0, "title", "TEXT", "title instead of maze and task", style.title)
      .section("instead of the picture")
      .flag(0, "ansi", "the path as text, in coloured blocks on a terminal that has colours", ansi)
      .text(0, "frames", "DIR", "a folder of numbered PNG files, one for the start and one after every step", frames)
      .text(0, "video", "FILE", "the same as a video: .avi, or .mp4, .mkv where OpenCV can", video)
      .real(0, "rate", "HZ", "the video's frames per second", rate, 0.1, 240);
  picture.add_to(options);
  const auto operands = options.parse(argc, argv, 0, 1);
  const bool draws_films = !frames.empty() || !video.empty();
  if (ansi && draws_films) fail(Exit::kUsage, "--ansi goes without --frames and --video");
  if (draws_films && options.given("output")) fail(Exit::kUsage, "--frames and --video take the place of the picture, but -o is given");
  if (options.given("rate") && video.empty()) fail(Exit::kUsage, "--rate is for --video");
  style.scale = picture.scale;

  std::unique_ptr<Output> output;
  if (!draws_films) output = std::make_unique<Output>(picture.output, ansi ? Output::Kind::kText : Output::Kind::kBinary, picture.force);
  const GridSet world = GridSet::open(world_name);
  Input input(operands.empty() ? "-" : operands[0]);
  const Read read = read_episode(input, world, line);
  const EnvTask pair = read.episode.pair;
  const Film film = play_film(world.maze(pair.env), world.tasks()[pair.task], to_grid_state(read.episode.start), read.episode.actions, read.window);
  if (ansi) {
    output->write(terminal_path(film, terminal_colour(output->is_stdout() ? 1 : -1)));
    output->finish();
    return 0;
  }
  const Font font(picture.font);
  if (!frames.empty()) write_frames(frames, film, style, font);
  if (!video.empty()) write_video(video, rate, film, style, font);
  if (output) finish(*output, draw_episode(film, style, font));
  return 0;
}
